#include <gtest/gtest.h>
#include <zip.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "meshes.hpp"
#include "model_files.hpp"

namespace routebench {
namespace {

using test::mentions;
using test::ModelFile;
using test::refusal_of;

constexpr ModelOptions kRepair{.repair = true};

std::string digits(double value) {
  std::array<char, 40> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

std::string words(const Point3& p) { return digits(p.x) + ' ' + digits(p.y) + ' ' + digits(p.z); }

/// One mesh in every format, with all its digits.
std::string as_off(const Mesh& mesh) {
  std::string text = "OFF\n" + std::to_string(mesh.vertices.size()) + ' ' +
                     std::to_string(mesh.triangles.size()) + " 0\n";
  for (const Point3& p : mesh.vertices) text += words(p) + '\n';
  for (const auto& [a, b, c] : mesh.triangles) {
    text += "3 " + std::to_string(a) + ' ' + std::to_string(b) + ' ' + std::to_string(c) + '\n';
  }
  return text;
}

std::string as_obj(const Mesh& mesh) {
  std::string text = "# a part\nmtllib part.mtl\no part\n";
  for (const Point3& p : mesh.vertices) text += "v " + words(p) + '\n';
  text += "vn 0 0 1\nvt 0.5 0.5\ng side\nusemtl red\ns off\n";
  for (const auto& [a, b, c] : mesh.triangles) {
    text += "f " + std::to_string(a + 1) + "/1/1 " + std::to_string(b + 1) + "//1 " +
            std::to_string(c + 1) + '\n';
  }
  return text;
}

template <typename T>
void put(std::string& bytes, T value, bool big_endian) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof value);
  if (big_endian) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

enum class Ply { kText, kLittleEndian, kBigEndian };

std::string as_ply(const Mesh& mesh, Ply kind) {
  constexpr std::array kNames{"ascii", "binary_little_endian", "binary_big_endian"};
  std::string bytes = std::string("ply\nformat ") + kNames[static_cast<std::size_t>(kind)] +
                      " 1.0\ncomment a part\nelement vertex " +
                      std::to_string(mesh.vertices.size()) +
                      "\nproperty uchar red\nproperty double x\nproperty double y\n"
                      "property double z\nelement face " +
                      std::to_string(mesh.triangles.size()) +
                      "\nproperty list uchar int vertex_indices\nproperty float quality\n"
                      "end_header\n";
  const bool big = kind == Ply::kBigEndian;
  for (const Point3& p : mesh.vertices) {
    if (kind == Ply::kText) {
      bytes += "255 " + words(p) + '\n';
      continue;
    }
    put(bytes, std::uint8_t{255}, big);
    for (const double c : {p.x, p.y, p.z}) put(bytes, c, big);
  }
  for (const auto& triangle : mesh.triangles) {
    if (kind == Ply::kText) bytes += '3';
    if (kind != Ply::kText) put(bytes, std::uint8_t{3}, big);
    for (const std::uint32_t v : triangle) {
      if (kind == Ply::kText) bytes += ' ' + std::to_string(v);
      if (kind != Ply::kText) put(bytes, static_cast<std::int32_t>(v), big);
    }
    if (kind == Ply::kText) bytes += " 0.5\n";
    if (kind != Ply::kText) put(bytes, 0.5F, big);
  }
  return bytes;
}

using Files = std::vector<std::pair<std::string, std::string>>;

/// A zip archive of some files.
std::string zipped(const Files& files) {
  const ModelFile place("archive.zip", "");
  zip_t* const zip = zip_open(place.path().c_str(), ZIP_CREATE | ZIP_TRUNCATE, nullptr);
  for (const auto& [name, content] : files) {
    zip_file_add(zip, name.c_str(), zip_source_buffer(zip, content.data(), content.size(), 0),
                 ZIP_FL_OVERWRITE);
  }
  EXPECT_EQ(zip_close(zip), 0);
  std::ifstream in(place.path(), std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

constexpr const char* kRelations =
    "<Relationships><Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";

std::string mesh_xml(const Mesh& mesh) {
  std::string xml = "<mesh><vertices>";
  for (const Point3& p : mesh.vertices) {
    xml +=
        "<vertex x=\"" + digits(p.x) + "\" y=\"" + digits(p.y) + "\" z=\"" + digits(p.z) + "\"/>";
  }
  xml += "</vertices><triangles>";
  for (const auto& [a, b, c] : mesh.triangles) {
    xml += "<triangle v1=\"" + std::to_string(a) + "\" v2=\"" + std::to_string(b) + "\" v3=\"" +
           std::to_string(c) + "\"/>";
  }
  return xml + "</triangles></mesh>";
}

std::string as_3mf(const std::string& resources, const std::string& build,
                   const std::string& attributes = "unit=\"millimeter\"", Files more = {}) {
  more.emplace_back("_rels/.rels", kRelations);
  more.emplace_back("3D/3dmodel.model",
                    "<?xml version=\"1.0\" encoding=\"UTF-8\"?><model " + attributes +
                        " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">"
                        "<resources>" +
                        resources + "</resources><build>" + build + "</build></model>");
  return zipped(more);
}

std::string object_xml(int id, const std::string& inside, const std::string& attributes = "") {
  return "<object id=\"" + std::to_string(id) + "\" " + attributes + ">" + inside + "</object>";
}

constexpr const char* kItem1 = "<item objectid=\"1\"/>";

/// A part whose coordinates need all their digits.
const Mesh& part() {
  static const Mesh mesh = load_model("shape:torus?triangles=1200&size=33.3").mesh;
  return mesh;
}

const Mesh& cube() {
  static const Mesh mesh = load_model("shape:box").mesh;
  return mesh;
}

/// Every format with the name that its files have.
Files in_every_format(const Mesh& mesh) {
  return {{"part.off", as_off(mesh)},
          {"part.obj", as_obj(mesh)},
          {"text.ply", as_ply(mesh, Ply::kText)},
          {"little.ply", as_ply(mesh, Ply::kLittleEndian)},
          {"big.ply", as_ply(mesh, Ply::kBigEndian)},
          {"part.3mf", as_3mf(object_xml(1, mesh_xml(mesh)), kItem1)}};
}

TEST(Formats, AllGiveTheSameModelWhateverTheNameSays) {
  const std::uint64_t hash = content_hash(load_model("shape:torus?triangles=1200&size=33.3").mesh);
  for (const auto& [name, bytes] : in_every_format(part())) {
    for (const std::string& called : {name, std::string("part"), std::string("part.stl")}) {
      if (name == "part.obj" && called == "part.stl") continue;  // OBJ has no mark of its own
      const ModelFile file(called, bytes);
      const Model model = load_model(file.path());
      EXPECT_EQ(content_hash(model.mesh), hash) << name << " as " << called;
      EXPECT_EQ(model.report.open_edges, 0U) << name;
      EXPECT_TRUE(model.warnings.empty()) << name << ": " << model.warnings.front();
    }
  }
}

TEST(Formats, TruncationsAreRefusedOrReadByRequest) {
  for (const auto& [name, bytes] : in_every_format(cube())) {
    const ModelFile file(name, "");
    // The last line end of a text is not missed, nor are the last face's colours.
    const std::size_t ends = name == "part.off" || name == "part.obj" ? 2 : 5;
    for (std::size_t length = 0; length + ends < bytes.size(); ++length) {
      file.rewrite(std::string_view(bytes).substr(0, length));
      for (const bool repair : {false, true}) {
        try {
          const Model model = load_model(file.path(), {.repair = repair});
          EXPECT_TRUE(repair || name == "part.obj") << name << ' ' << length;
          EXPECT_GT(model.report.open_edges, 0U) << name << ' ' << length;
        } catch (const Error& error) {
          EXPECT_EQ(error.kind(), ErrorKind::kBadInput) << name << ' ' << length;
        }
      }
    }
  }
}

TEST(Formats, FlippedBitsNeverDoWorseThanAnError) {
  for (const auto& [name, bytes] : in_every_format(cube())) {
    const ModelFile file(name, "");
    for (std::size_t bit = 0; bit < bytes.size() * 8; bit += 11) {
      std::string damaged = bytes;
      damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
      file.rewrite(damaged);
      try {
        static_cast<void>(load_model(file.path(), {.repair = bit % 2 == 0}));
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::kBadInput) << name << ' ' << bit;
      }
    }
  }
}

TEST(Formats, PolygonsAreCutAlsoWhereTheyAreConcave) {
  // A U of height 3 whose ends are concave octagons and whose sides are rectangles.
  const std::string u =
      "OFF\n16 10 0\n"
      "0 0 0\n3 0 0\n3 3 0\n2 3 0\n2 1 0\n1 1 0\n1 3 0\n0 3 0\n"
      "0 0 3\n3 0 3\n3 3 3\n2 3 3\n2 1 3\n1 1 3\n1 3 3\n0 3 3\n"
      "8 7 6 5 4 3 2 1 0\n8 8 9 10 11 12 13 14 15\n"
      "4 0 1 9 8\n4 1 2 10 9\n4 2 3 11 10\n4 3 4 12 11\n"
      "4 4 5 13 12\n4 5 6 14 13\n4 6 7 15 14\n4 7 0 8 15\n";
  const ModelFile file("u.off", u);
  const Model model = load_model(file.path());
  EXPECT_EQ(model.mesh.triangles.size(), 28U);
  EXPECT_EQ(model.report.open_edges, 0U);
  EXPECT_DOUBLE_EQ(model.report.volume_mm3, 21);
  // No triangle reaches over the gap: each lies in the ends' plane within the U.
  for (const auto& t : model.mesh.triangles) {
    Point3 middle;
    for (const std::uint32_t v : t) {
      middle.x += model.mesh.vertices[v].x / 3;
      middle.y += model.mesh.vertices[v].y / 3;
    }
    EXPECT_FALSE(middle.x > 1.01 && middle.x < 1.99 && middle.y > 1.01);
  }
}

TEST(Formats, AFaceMayBeBridgedToItsHole) {
  // A square tube; its ends are squares joined to their holes by a bridge that is run both ways.
  const std::string tube =
      "OFF\n16 10 0\n"
      "0 0 0\n4 0 0\n4 4 0\n0 4 0\n1 1 0\n3 1 0\n3 3 0\n1 3 0\n"
      "0 0 2\n4 0 2\n4 4 2\n0 4 2\n1 1 2\n3 1 2\n3 3 2\n1 3 2\n"
      "10 8 9 10 11 8 12 15 14 13 12\n10 4 5 6 7 4 0 3 2 1 0\n"
      "4 0 1 9 8\n4 1 2 10 9\n4 2 3 11 10\n4 3 0 8 11\n"
      "4 5 4 12 13\n4 6 5 13 14\n4 7 6 14 15\n4 4 7 15 12\n";
  const ModelFile file("tube.off", tube);
  const Model model = load_model(file.path());
  EXPECT_EQ(model.report.open_edges, 0U);
  EXPECT_EQ(model.report.non_manifold_edges, 0U);
  EXPECT_EQ(model.mesh.triangles.size(), 32U);
  EXPECT_DOUBLE_EQ(model.report.volume_mm3, 24);
}

TEST(Formats, OffVariantsAreRead) {
  const std::string body =
      "4 4 6\n0 0 0 255 0 0\n10 0 0 1 0 0 # red\n\n0 10 0 0 0 1\n0 0 10 0 0 0\n"
      "3 0 2 1\n3 0 1 3 255 0 0\n3 1 2\n 3\n# remark\n3 2 0 3\n";
  for (const std::string& head :
       {std::string("COFF\n"), std::string("OFF "), std::string(""),
        std::string("\xEF\xBB\xBFOFF\n"), std::string("# made\n\nNOFF\n")}) {
    const ModelFile file("part.off", head + body);
    EXPECT_NEAR(load_model(file.path()).report.volume_mm3, 1000.0 / 6, 1e-9) << head;
  }
}

struct Fault {
  const char* name;
  std::string bytes;
  const char* complaint;
};

TEST(Formats, FaultsAreNamedWithTheirPlace) {
  const std::string ply = as_ply(cube(), Ply::kText);
  const auto edited = [](std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  const std::string off = as_off(cube());
  const std::string obj = as_obj(cube());
  for (const Fault& fault : std::vector<Fault>{
           {"a.off", edited(off, "3 0 2 1", "3 0 2 8"), "(line 11) names vertex 8"},
           {"a.off", edited(off, "3 0 2 1", "3 0 2 -1"), "(line 11) names vertex -1"},
           {"a.off", edited(off, "20 0 0", "20 nan 0"), "the y of vertex 1"},
           {"a.off", edited(off, "20 0 0", "20 1e400 0"), "is inf"},
           {"a.off", edited(off, "20 0 0", "20 x 0"), "line 4: 'x' is not a number"},
           {"a.off", edited(off, "20 0 0", "20 0"), "line 4: a number is missing"},
           {"a.off", edited(off, "20 0 0", "20 0,0 0"), "line 4: '0,0' is written with a comma"},
           {"a.off", edited(off, "8 12 0", "4000000000 12 0"), "too short for 4000000000"},
           {"a.off", edited(off, "8 12 0", "8 99999999999 0"), "too short"},
           {"a.off", edited(off, "8 12 0", "8 99999999999999999999 0"), "not a whole number"},
           {"a.off", edited(off, "8 12 0", "-8 12 0"), "cannot be meant"},
           {"a.off", edited(off, "OFF", "4OFF"), "other than three dimensions"},
           {"a.off", edited(off, "OFF", "OFF BINARY"), "binary OFF"},
           {"a.off", edited(off, "8 12 0", "8 0 0"), "no faces"},
           {"a.off", "OFF", "is missing"},
           {"a.obj", edited(obj, "f 1/1/1", "f 9/1/1"), "(line 17) names vertex 8"},
           {"a.obj", edited(obj, "f 1/1/1", "f 0/1/1"), "line 17: vertex 0"},
           {"a.obj", edited(obj, "f 1/1/1", "f -9/1/1"), "(line 17) names vertex -1"},
           {"a.obj", edited(obj, "f 1/1/1", "f one"), "line 17: 'one' is not a whole number"},
           {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "no faces"},
           {"a.obj", "f 1 2", "three corners"},
           {"a.ply", edited(ply, "ascii", "ancient"), "line 2: 'ancient' is not a PLY format"},
           {"a.ply", edited(ply, "double x", "quad x"), "line 6: 'quad' is not a type"},
           {"a.ply", edited(ply, "double x", "double w"), "without a property x"},
           {"a.ply", edited(ply, "vertex_indices", "corners"), "without a list of vertex_indices"},
           {"a.ply", edited(ply, "list uchar", "list float"), "line 10: the length of a list"},
           {"a.ply", edited(ply, "vertex 8", "vertex 4000000000"), "announces 4000000000"},
           {"a.ply", edited(ply, "face 12", "face 4000000000"), "announces 4000000000"},
           {"a.ply", edited(ply, "vertex 8", "vertex -8"), "cannot be meant"},
           {"a.ply", edited(ply, "end_header", "end_heading"), "does not belong"},
           {"a.ply", edited(ply, "3 0 2 1 0.5", "3 0 2 99 0.5"), "names vertex 99"},
           {"a.ply", edited(ply, "3 0 2 1 0.5", "3 0 2 0.5 0.5"), "is no number of a vertex"},
           {"a.ply", edited(ply, "3 0 2 1 0.5", "-3 0 2 1 0.5"), "cannot be meant"},
           {"a.ply", "not a ply", "must begin with the word ply"},
           {"a.3mf", "not a zip", "must be a zip archive"},
           {"a.xyz", "hello", "neither STL nor OBJ, OFF, PLY or 3MF"},
           {"a.wkt", "MULTIPOLYGON EMPTY", "a file of layers is no mesh"},
       }) {
    const ModelFile file(fault.name, fault.bytes);
    const std::string message = refusal_of(file.path());
    EXPECT_NE(message.find(fault.complaint), std::string::npos) << message;
  }
}

TEST(Formats, RepairDropsFacesWithCornersThatAreNotFinite) {
  std::string off = as_off(cube());
  off.replace(off.find("20 20 20"), 8, "20 nan 20");
  const ModelFile file("part.off", off);
  const Model model = load_model(file.path(), kRepair);
  EXPECT_LT(model.mesh.triangles.size(), 12U);
  EXPECT_GT(model.report.open_edges, 0U);
  EXPECT_TRUE(mentions(model.warnings, "left out"));
}

TEST(Formats, ObjTakesRelativeNumbersAndContinuedLines) {
  const ModelFile file("part.obj",
                       "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\n"
                       "f -4 -2 -3\nf 1 2 \\\n 4\nf 2//1 3//1 4//1\nf 3 1 4\nl 1 2\n");
  EXPECT_NEAR(load_model(file.path()).report.volume_mm3, 1000.0 / 6, 1e-9);
}

TEST(ThreeMf, ItemsComponentsAndTransformationsArePlaced) {
  const std::string resources =
      object_xml(1, mesh_xml(cube())) +
      object_xml(2,
                 "<components><component objectid=\"1\"/>"
                 "<component objectid=\"1\" transform=\"0.5 0 0 0 0.5 0 0 0 0.5 30 0 0\"/>"
                 "</components>") +
      object_xml(3, mesh_xml(cube()), "type=\"support\"");
  const std::string build =
      "<item objectid=\"2\" transform=\"0 1 0 -1 0 0 0 0 1 100 0 5\"/>"  // a quarter turn
      "<item objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 200 0 5\"/>"  // mirrored
      "<item objectid=\"1\" printable=\"0\"/><item objectid=\"3\"/>";
  const ModelFile file("plate.3mf", as_3mf(resources, build));
  const Model model = load_model(file.path());
  EXPECT_EQ(model.report.components, 3U);
  EXPECT_DOUBLE_EQ(model.report.volume_mm3, 8000 + 1000 + 8000);
  EXPECT_DOUBLE_EQ(model.report.lower_mm.x, 80);
  EXPECT_DOUBLE_EQ(model.report.lower_mm.y, 0);
  EXPECT_DOUBLE_EQ(model.report.upper_mm.x, 200);
  EXPECT_DOUBLE_EQ(model.report.upper_mm.y, 40);
  EXPECT_DOUBLE_EQ(model.report.upper_mm.z, 20);
  EXPECT_TRUE(model.warnings.empty()) << model.warnings.front();
}

TEST(ThreeMf, UnitsAreTurnedIntoMillimetres) {
  const std::string resources = object_xml(1, mesh_xml(cube()));
  for (const auto& [unit, mm] : {std::pair("micron", 0.001), std::pair("centimeter", 10.0),
                                 std::pair("inch", 25.4), std::pair("foot", 304.8)}) {
    const ModelFile file("part.3mf",
                         as_3mf(resources, kItem1, std::string("unit=\"") + unit + "\""));
    EXPECT_NEAR(load_model(file.path()).report.upper_mm.z, 20 * mm, 1e-9 * mm) << unit;
  }
  const ModelFile file("part.3mf", as_3mf(resources, kItem1, "unit=\"ell\""));
  EXPECT_NE(refusal_of(file.path()).find("unit 'ell'"), std::string::npos);
}

TEST(ThreeMf, ComponentsMayLieInOtherPartsOfThePackage) {
  const std::string other =
      "<model><resources>" + object_xml(7, mesh_xml(cube())) + "</resources></model>";
  const std::string resources = object_xml(
      1, "<components><component p:path=\"/3D/Objects/a.model\" objectid=\"7\"/></components>");
  const ModelFile file("part.3mf", as_3mf(resources, kItem1, "", {{"3D/Objects/a.model", other}}));
  EXPECT_DOUBLE_EQ(load_model(file.path()).report.volume_mm3, 8000);
}

TEST(ThreeMf, FaultsAreNamed) {
  const std::string good = object_xml(1, mesh_xml(cube()));
  const auto components = [](int id, int count, int of) {
    std::string inside = "<components>";
    for (int i = 0; i < count; ++i) {
      inside += "<component objectid=\"" + std::to_string(of) + "\"/>";
    }
    return object_xml(id, inside + "</components>");
  };
  std::string many = object_xml(1, "<mesh/>");
  for (int id = 2; id < 12; ++id) many += components(id, 10, id - 1);
  std::string bad_corner = good;
  bad_corner.replace(bad_corner.find("v1=\"0\""), 6, "v1=\"8\"");
  std::string bad_number = good;
  bad_number.replace(bad_number.find("x=\"20\""), 6, "x=\"2O\"");
  for (const Fault& fault : std::vector<Fault>{
           {"a.3mf", as_3mf(good, ""), "no item to print"},
           {"a.3mf", as_3mf(good, "<item objectid=\"5\"/>"), "there is no object '5'"},
           {"a.3mf", as_3mf(object_xml(1, ""), kItem1), "neither a mesh nor"},
           {"a.3mf", as_3mf(object_xml(1, "<mesh/>"), kItem1), "no faces"},
           {"a.3mf", as_3mf(components(1, 1, 2) + components(2, 1, 1), kItem1), "without end"},
           {"a.3mf", as_3mf(many, "<item objectid=\"11\"/>"), "without end"},
           {"a.3mf", as_3mf(bad_corner, kItem1), "object 1, triangle 0: '8' is none of the 8"},
           {"a.3mf", as_3mf(bad_number, kItem1), "'2O' is not a number"},
           {"a.3mf", as_3mf(good, "<item objectid=\"1\" transform=\"1 2 3\"/>"), "12 numbers"},
           {"a.3mf", as_3mf(good + "<object", kItem1), "3D/3dmodel.model, byte"},
           {"a.3mf", zipped({{"readme.txt", "hello"}}), "holds no model"},
           {"a.3mf", zipped({{"_rels/.rels", kRelations}}), "lacks 3D/3dmodel.model"},
           {"a.3mf",
            as_3mf(object_xml(1, "<mesh><vertices/><triangles/><b:beamlattice/></mesh>"), kItem1),
            "beam lattice"},
       }) {
    const ModelFile file(fault.name, fault.bytes);
    const std::string message = refusal_of(file.path());
    EXPECT_NE(message.find(fault.complaint), std::string::npos) << message;
  }
}

TEST(ThreeMf, PartsThatASlicerMarksAreReported) {
  const std::string settings =
      "<config><metadata key=\"volume_type\" value=\"NegativeVolume\"/></config>";
  const ModelFile file("part.3mf", as_3mf(object_xml(1, mesh_xml(cube())), kItem1, "",
                                          {{"Metadata/Slic3r_PE_model.config", settings}}));
  EXPECT_TRUE(mentions(load_model(file.path()).warnings, "NegativeVolume"));
}

TEST(CgalData, IsReadOrMissedByName) {
  const std::string spec = "cgal:meshes/elephant.off?size=60";
  try {
    const Model model = load_model(spec);
    EXPECT_EQ(model.report.triangles, 5558U);
    const Point3& low = model.report.lower_mm;
    const Point3& high = model.report.upper_mm;
    EXPECT_NEAR(std::max({high.x - low.x, high.y - low.y, high.z - low.z}), 60, 1e-9);
    EXPECT_EQ(model.report.open_edges, 0U);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("libcgal-demo"), std::string::npos) << error.what();
    GTEST_SKIP() << "no data set on this machine: " << error.what();
  }
  const std::string message = refusal_of("cgal:meshes/elefant.off");
  EXPECT_NE(message.find("did you mean 'meshes/elephant.off'?"), std::string::npos) << message;
}

TEST(FileNames, KnowOnlyTheSize) {
  const ModelFile file("part.off", as_off(cube()));
  EXPECT_DOUBLE_EQ(load_model(file.path() + "?size=50").report.upper_mm.x, 50);
  EXPECT_NE(refusal_of(file.path() + "?sise=50").find("'sise'"), std::string::npos);
  for (const char* const size : {"0", "-5", "nan", "inf", "1e9", "5mm", "1,5"}) {
    EXPECT_NE(refusal_of(file.path() + "?size=" + size).find("0.01..10000"), std::string::npos);
  }
  EXPECT_NE(refusal_of(file.path() + "?size").find("key=value"), std::string::npos);
  EXPECT_NE(refusal_of(file.path() + "?size=1&size=2").find("twice"), std::string::npos);
  const ModelFile question("part?size=50.off", as_off(cube()));
  EXPECT_DOUBLE_EQ(load_model(question.path()).report.upper_mm.x, 20);
}

}  // namespace
}  // namespace routebench
