"""Types of arrays that the rooms exchange."""

from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray


class _Stored:
    """How pydantic stores an array: nested lists of numbers, NaN and infinity as text."""

    def __init__(self, dtype: type[float] | type[bool]) -> None:
        self.dtype = dtype

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        from pydantic_core import core_schema

        return core_schema.no_info_plain_validator_function(
            lambda value: np.array(value, dtype=self.dtype),
            serialization=core_schema.plain_serializer_function_ser_schema(lambda value: value.tolist()),
        )


Array = Annotated[NDArray[np.float64], _Stored(float)]
FloatArray = NDArray[np.floating]  # as the methods return them
Coatings = tuple[tuple[float, float, float], ...]
Ball = tuple[float, float, Coatings]  # E [Pa], nu of its substrate; coatings from its surface inwards
