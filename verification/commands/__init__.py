"""The commands of coatcheck, one file each; verification.cli names them."""
