// Coated solid below a stiff cap with a parabolic face; x radial, y up, lengths over a_h. A hole of radius
// 0.002 along the axis keeps the elements there from collapsing, which would lose their contact.
SetFactory("OpenCASCADE");
z[] = {%(z)s};
far = 2000; hole = 0.002; rim = 3; top = 2; pieces = 80;
For k In {1:#z[]-1}
  Rectangle(k) = {hole, -z[k], 0, far, z[k] - z[k-1]};
EndFor
If (#z[] > 2)
  Coherence;
EndIf
For i In {0:pieces}
  r = hole + i * (rim - hole) / pieces;
  p[] += newp; Point(p[i]) = {r, r^2 * %(bend)s, 0};
EndFor
p[] += newp; Point(p[pieces+1]) = {rim, top, 0};
p[] += newp; Point(p[pieces+2]) = {hole, top, 0};
l = newl;
Spline(l) = p[{0:pieces}];
For i In {1:2}
  Line(l+i) = {p[pieces+i-1], p[pieces+i]};
EndFor
Line(l+3) = {p[pieces+2], p[0]};
c = newll; Curve Loop(c) = {l:l+3};
Plane Surface(#z[]) = {c};
For k In {1:#z[]}
  Physical Surface(Sprintf("S%%g", k), k) = {k};
EndFor
Field[1] = MathEval;
Field[1].F = "%(size)s * Max(1, Sqrt(x*x + y*y) / 1.3)";
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.ElementOrder = 2;
Mesh.Format = 39;  // Abaqus
