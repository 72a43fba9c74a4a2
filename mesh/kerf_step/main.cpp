// kerf-step - a STEP file (AP203, AP214, AP242) as a triangle mesh. It is a program of its own, so
// that kerf itself does not link OpenCASCADE.
//
//     kerf-step FILE [DEVIATION_MM]      binary STL on standard output, in mm
//     kerf-step --version
//
// Triangles are nowhere farther than DEVIATION_MM (default 0.01) from the faces of the model.
// Faces share the corners along their edges: the mesh of a closed solid is closed. What the model's
// solids are beside (loose faces, wires) counts as well where there is no solid. The file says its
// unit. Status: 0, 2 for a wrong call, 4 for a file that cannot be read; what is wrong is on
// standard error.
#include <unistd.h>

#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace {

constexpr int kUsageError = 2, kFileError = 4;
constexpr double kDeviation_mm = 0.01, kLeast_mm = 1e-4, kMost_mm = 10;
/// Between neighbouring triangles of a curved face, rad: small fillets get some, too.
constexpr double kAngle = 0.35;

int fail(int status, const std::string& text) {
  std::fprintf(stderr, "%s\n", text.c_str());
  return status;
}

class StlBytes {
 public:
  StlBytes() : bytes_(84, '\0') {
    constexpr char kHead[] = "kerf-step, mm";
    std::memcpy(bytes_.data(), kHead, sizeof kHead);
  }
  void add(const gp_Pnt (&corners)[3]) {
    append_float(0), append_float(0), append_float(0);  // normals are computed by who reads it
    for (const gp_Pnt& p : corners) append_float(p.X()), append_float(p.Y()), append_float(p.Z());
    bytes_.append(2, '\0');
    ++count_;
  }
  std::uint32_t count() const { return count_; }
  bool write(int out) {
    std::memcpy(bytes_.data() + 80, &count_, sizeof count_);
    const char* at = bytes_.data();
    for (std::size_t left = bytes_.size(); left > 0;) {
      const ssize_t n = ::write(out, at, left);
      if (n <= 0) return false;
      at += n;
      left -= static_cast<std::size_t>(n);
    }
    return true;
  }

 private:
  void append_float(double value) {
    const float number = static_cast<float>(value);
    char four[sizeof number];
    std::memcpy(four, &number, sizeof number);
    bytes_.append(four, sizeof number);
  }
  std::string bytes_;
  std::uint32_t count_ = 0;
};

/// False: a face could not be divided into triangles.
bool add_face(const TopoDS_Face& face, StlBytes& stl) {
  TopLoc_Location place;
  const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, place);
  if (mesh.IsNull()) return false;
  const gp_Trsf& move = place.Transformation();
  const bool is_turned = (face.Orientation() == TopAbs_REVERSED) != move.IsNegative();
  for (int t = 1; t <= mesh->NbTriangles(); ++t) {
    int a, b, c;
    mesh->Triangle(t).Get(a, b, c);
    if (is_turned) std::swap(b, c);
    const gp_Pnt corners[3] = {mesh->Node(a).Transformed(move), mesh->Node(b).Transformed(move),
                               mesh->Node(c).Transformed(move)};
    stl.add(corners);
  }
  return true;
}

int convert(const std::string& path, double deviation_mm, int out) {
  // OpenCASCADE tells of its progress on standard output; this has its own words.
  Message::DefaultMessenger()->ChangePrinters().Clear();
  if (::access(path.c_str(), R_OK) != 0)
    return fail(kFileError, "cannot read " + path + ": " + std::strerror(errno));
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  STEPControl_Reader reader;
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone)
    return fail(kFileError, path + ": is no STEP file that OpenCASCADE reads");
  reader.TransferRoots();
  const TopoDS_Shape shape = reader.OneShape();
  if (shape.IsNull()) return fail(kFileError, path + ": has no shape in it");
  BRepMesh_IncrementalMesh mesher(shape, deviation_mm, false, kAngle, false);
  const bool has_solids = TopExp_Explorer(shape, TopAbs_SOLID).More();
  StlBytes stl;
  int missing = 0;
  for (TopExp_Explorer part(shape, has_solids ? TopAbs_SOLID : TopAbs_FACE); part.More();
       part.Next()) {
    for (TopExp_Explorer face(part.Current(), TopAbs_FACE); face.More(); face.Next())
      missing += add_face(TopoDS::Face(face.Current()), stl) ? 0 : 1;
  }
  if (missing > 0)
    return fail(kFileError, path + ": OpenCASCADE cannot divide " + std::to_string(missing) +
                                " of its faces into triangles");
  if (stl.count() == 0) return fail(kFileError, path + ": has no faces");
  if (!stl.write(out))
    return fail(kFileError, std::string("cannot write: ") + std::strerror(errno));
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  const std::vector<std::string> given(arguments + 1, arguments + count);
  if (given.size() == 1 && given[0] == "--version") {
    std::puts("kerf-step " KERF_VERSION);
    return 0;
  }
  if (given.empty() || given.size() > 2)
    return fail(kUsageError, "usage: kerf-step FILE [DEVIATION_MM] > FILE.stl");
  double deviation = kDeviation_mm;
  if (given.size() == 2) {
    char* end = nullptr;
    deviation = std::strtod(given[1].c_str(), &end);
    if (end == given[1].c_str() || *end != '\0' || !(deviation >= kLeast_mm) ||
        !(deviation <= kMost_mm))
      return fail(kUsageError, "DEVIATION_MM: '" + given[1] +
                                   "' is not allowed; must be from 0.0001 to 10 (mm)");
  }
  // What libraries print must not get into the mesh.
  const int out = ::dup(STDOUT_FILENO);
  if (out < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0)
    return fail(kFileError, std::string("standard output: ") + std::strerror(errno));
  try {
    return convert(given[0], deviation, out);
  } catch (const Standard_Failure& failure) {
    return fail(kFileError, given[0] + ": " + failure.GetMessageString());
  }
}
