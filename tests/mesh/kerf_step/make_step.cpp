// make_step box|tube|two FILE [inch]: a STEP file with bodies of known size, for the tests.
//     box    10 x 20 x 30 mm from 1, 2, 3
//     tube   diameter 20 and 12, Z-30..0, less a slot of 4 mm across it
//     two    the box, and a sphere of diameter 8 beside it, turned about Z by 30 degrees
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Builder.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Writer.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Ax1.hxx>
#include <gp_Trsf.hxx>
#include <string>

int main(int count, char** arguments) {
  if (count < 3) return 2;
  const std::string what = arguments[1];
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(1, 2, 3), 10, 20, 30).Shape();
  TopoDS_Shape shape = box;
  if (what == "tube") {
    const gp_Ax2 axis(gp_Pnt(0, 0, -30), gp_Dir(0, 0, 1));
    shape = BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(axis, 10, 30).Shape(),
                            BRepPrimAPI_MakeCylinder(axis, 6, 30).Shape());
    shape = BRepAlgoAPI_Cut(shape, BRepPrimAPI_MakeBox(gp_Pnt(-20, -2, -5), 40, 4, 5).Shape());
  }
  if (what == "two") {
    gp_Trsf turn;
    turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 3.14159265358979 / 6);
    TopoDS_Compound both;
    const BRep_Builder builder;
    builder.MakeCompound(both);
    builder.Add(both, BRepBuilderAPI_Transform(box, turn).Shape());
    builder.Add(both, BRepPrimAPI_MakeSphere(gp_Pnt(-20, 0, 4), 4).Shape());
    shape = both;
  }
  STEPControl_Writer writer;
  // The file's numbers stay, and are inches.
  if (count > 3) Interface_Static::SetCVal("write.step.unit", "INCH");
  writer.Transfer(shape, STEPControl_AsIs);
  return writer.Write(arguments[2]) == IFSelect_RetDone ? 0 : 4;
}
