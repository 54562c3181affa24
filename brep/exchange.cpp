// Solids of STEP and IGES files.
//
// Names and colors are read from the entities of the file: the kernel's own documents (XCAF) would
// need its libraries for drawing. Shapes of entities are found by their TShape, which all instances of
// a part share.

#include "brep/exchange.hpp"

#include "brep/handle.hpp"

#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <IGESGraph_Color.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPConstruct.hxx>
#include <STEPConstruct_ExternRefs.hxx>
#include <STEPConstruct_Styles.hxx>
#include <STEPControl_Reader.hxx>
#include <StepBasic_Product.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepBasic_ProductDefinitionFormation.hxx>
#include <StepData_StepModel.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <StepVisual_Colour.hxx>
#include <StepVisual_ColourRgb.hxx>
#include <StepVisual_StyledItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Shell.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <set>

namespace brep {

// Gaps between faces of IGES files that are closed, in millimeters: files have their faces one by one.
static const double IGES_GAP = 1e-3;

struct Color {
  double channels[3];
};

typedef std::map<const TopoDS_TShape *, std::string> Names;
typedef std::map<const TopoDS_TShape *, Color> Colors;

// ---- texts ----

static bool is_utf8(const std::string &text) {
  for (size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const size_t size = lead < 0x80       ? 1
                        : lead >> 5 == 6  ? 2
                        : lead >> 4 == 14 ? 3
                        : lead >> 3 == 30 ? 4
                                          : 0;
    if (!size || i + size > text.size() || (size == 2 && lead < 0xc2)) return false;
    for (size_t k = 1; k < size; ++k)
      if ((static_cast<unsigned char>(text[i + k]) & 0xc0) != 0x80) return false;
    i += size;
  }
  return true;
}

static void append_utf8(std::string &text, uint32_t c) {
  if (c < 0x80) {
    text += static_cast<char>(c);
  } else if (c < 0x800) {
    text += static_cast<char>(0xc0 | c >> 6);
    text += static_cast<char>(0x80 | (c & 0x3f));
  } else if (c < 0x10000) {
    text += static_cast<char>(0xe0 | c >> 12);
    text += static_cast<char>(0x80 | (c >> 6 & 0x3f));
    text += static_cast<char>(0x80 | (c & 0x3f));
  } else {
    text += static_cast<char>(0xf0 | c >> 18);
    text += static_cast<char>(0x80 | (c >> 12 & 0x3f));
    text += static_cast<char>(0x80 | (c >> 6 & 0x3f));
    text += static_cast<char>(0x80 | (c & 0x3f));
  }
}

// The number that `digits` hexadecimal digits spell; false if they are none.
static bool read_hex(const std::string &text, size_t at, size_t digits, uint32_t &value) {
  value = 0;
  for (size_t i = at; i < at + digits; ++i) {
    const char c = i < text.size() ? text[i] : ' ';
    if (!std::isxdigit(static_cast<unsigned char>(c))) return false;
    value = value * 16 + static_cast<uint32_t>(c <= '9' ? c - '0' : (c | 32) - 'a' + 10);
  }
  return true;
}

// Decodes the control directives of ISO 10303-21 (\X2\00E9\X0\, \X4\...\X0\, \X\E9, \S\i), which the
// kernel may leave.
static std::string decode_directives(const std::string &text) {
  std::string out;
  for (size_t i = 0; i < text.size();) {
    uint32_t c = 0;
    const bool two = text.compare(i, 4, "\\X2\\") == 0, four = text.compare(i, 4, "\\X4\\") == 0;
    if (two || four) {
      size_t at = i + 4;
      for (const size_t digits = two ? 4 : 8; read_hex(text, at, digits, c); at += digits) {
        uint32_t low = 0;
        if (two && c >= 0xd800 && c < 0xdc00 && read_hex(text, at + 4, 4, low) && low >= 0xdc00 &&
            low < 0xe000) {
          c = 0x10000 + ((c - 0xd800) << 10) + (low - 0xdc00);
          at += 4;
        }
        if (c < 0x110000 && (c < 0xd800 || c >= 0xe000)) append_utf8(out, c);
      }
      i = text.compare(at, 4, "\\X0\\") == 0 ? at + 4 : at;
    } else if (text.compare(i, 3, "\\X\\") == 0 && read_hex(text, i + 3, 2, c)) {
      append_utf8(out, c);
      i += 5;
    } else if (text.compare(i, 3, "\\S\\") == 0 && i + 3 < text.size()) {
      append_utf8(out, (static_cast<unsigned char>(text[i + 3]) & 0x7fu) | 0x80u);
      i += 4;
    } else {
      out += text[i++];
    }
  }
  return out;
}

static std::string text_of(const Ref<TCollection_HAsciiString> &string) {
  if (string.IsNull()) return "";
  std::string text = string->ToCString();
  if (!is_utf8(text)) {
    // Bytes of ISO 8859-1.
    std::string converted;
    for (const char c : text) append_utf8(converted, static_cast<unsigned char>(c));
    text = converted;
  }
  text = decode_directives(text);
  const size_t first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

// ---- parts ----

static double linear(double channel) {
  channel = std::min(std::max(channel, 0.0), 1.0);
  return channel <= 0.04045 ? channel / 12.92 : std::pow((channel + 0.055) / 1.055, 2.4);
}

// The parts that were made of a solid, and where it was placed.
struct Placed {
  size_t first, count;
  gp_Trsf map;
};

// The shapes of a file, on the way to their solids: each part has the name and the color of its
// nearest ancestor that has one.
struct Walk {
  const Names &solid_names, &product_names;
  const Colors &colors;
  bool assembly; // the file has several products
  std::vector<Part> parts;
  TopoDS_Shape loose; // faces and shells outside of solids
  std::map<std::pair<const TopoDS_TShape *, TopAbs_Orientation>, Placed> placed;

  void add_solid(const TopoDS_Shape &shape, const Part &like);
  void visit(const TopoDS_Shape &shape, const std::string &outer_product, const Color *color,
             bool outer_alone);
};

// The color of most faces.
static const Color *face_color(const TopoDS_Shape &solid, const Colors &colors) {
  const Color *best = nullptr;
  int most = 0;
  std::map<std::vector<double>, int> counts;
  for (TopExp_Explorer it(solid, TopAbs_FACE); it.More(); it.Next()) {
    const auto found = colors.find(it.Current().TShape().get());
    if (found == colors.end()) continue;
    const double *c = found->second.channels;
    const int count = ++counts[{c[0], c[1], c[2]}];
    if (count > most) {
      most = count;
      best = &found->second;
    }
  }
  return best;
}

static int count_solids(const TopoDS_Shape &shape) {
  int n = 0;
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) ++n;
  return n;
}

// The solid where it is placed, with the location in its geometry. Repaired if it is not valid.
static Solids placed_solids(const TopoDS_Shape &shape, const std::string &name) {
  const gp_Trsf map = shape.Location().Transformation();
  TopoDS_Shape placed = shape.Located(TopLoc_Location());
  if (map.Form() != gp_Identity)
    placed = BRepBuilderAPI_Transform(placed, map, Standard_True).Shape();
  Solids solids = solids_of(placed);
  if (!are_valid(solids)) {
    const Solids repaired = repair(solids);
    if (!repaired.empty() &&
        std::abs(volume_of(repaired) - volume_of(solids)) < 1e-3 * std::abs(volume_of(solids)))
      solids = repaired;
  }
  for (const TopoDS_Solid &solid : solids)
    for (TopExp_Explorer it(solid, TopAbs_SHELL); it.More(); it.Next())
      if (!BRep_Tool::IsClosed(it.Current()))
        throw Failure{CAG_BREP_FAIL_FILE, "the solid `" + name + "` is not closed"};
  return solids;
}

static bool is_rigid(const gp_Trsf &map) {
  return !map.IsNegative() && std::abs(map.ScaleFactor() - 1) < 1e-12;
}

// Adds the parts of a solid, with a name and a color. Further solids of one shape become copies.
void Walk::add_solid(const TopoDS_Shape &shape, const Part &like) {
  const gp_Trsf map = shape.Location().Transformation();
  const auto found = placed.find({shape.TShape().get(), shape.Orientation()});
  Part part = like;
  if (found != placed.end() && is_rigid(map)) {
    const Placed &before = found->second;
    part.placement = map.Multiplied(before.map.Inverted());
    for (part.original = before.first; part.original < before.first + before.count; ++part.original)
      parts.push_back(part);
    return;
  }
  const size_t first = parts.size();
  for (const TopoDS_Solid &solid : placed_solids(shape, like.name)) {
    part.solid = solid;
    parts.push_back(part);
  }
  if (is_rigid(map))
    placed.insert(
        {{shape.TShape().get(), shape.Orientation()}, {first, parts.size() - first, map}});
}

void Walk::visit(const TopoDS_Shape &shape, const std::string &outer_product, const Color *color,
                 bool outer_alone) {
  if (shape.IsNull()) return;
  const TopoDS_TShape *key = shape.TShape().get();
  const auto colored = colors.find(key);
  if (colored != colors.end()) color = &colored->second;
  // A product with one solid may have it as its shape.
  const auto named = product_names.find(key);
  const bool is_product = named != product_names.end();
  if (shape.ShapeType() == TopAbs_SOLID) {
    const std::string product = is_product ? named->second : outer_product;
    const bool alone = is_product || outer_alone;
    const auto own = solid_names.find(key);
    std::string name = own == solid_names.end() ? "" : own->second;
    if (name.empty() || name == "NONE" || (assembly && alone && !product.empty())) name = product;
    if (colored == colors.end()) {
      const Color *of_faces = face_color(shape, colors);
      if (of_faces) color = of_faces;
    }
    Part like;
    like.name = name;
    like.has_color = color != nullptr;
    for (int i = 0; color && i < 3; ++i) like.color[i] = linear(color->channels[i]);
    return add_solid(shape, like);
  }
  if (shape.ShapeType() > TopAbs_SOLID) {
    if (shape.ShapeType() > TopAbs_FACE) return;
    BRep_Builder builder;
    if (loose.IsNull()) {
      TopoDS_Compound compound;
      builder.MakeCompound(compound);
      loose = compound;
    }
    builder.Add(loose, shape);
    return;
  }
  const int solids = is_product ? count_solids(shape) : 0;
  for (TopoDS_Iterator it(shape); it.More(); it.Next())
    visit(it.Value(), is_product ? named->second : outer_product, color,
          is_product ? solids == 1 : outer_alone);
}

// Closed surfaces of the loose faces are solids, too.
static void add_loose(Walk &walk, double gap) {
  if (walk.loose.IsNull()) return;
  BRepBuilderAPI_Sewing sewing(gap);
  sewing.Add(walk.loose);
  sewing.Perform();
  if (sewing.SewedShape().IsNull()) return;
  // Names and colors of the faces that sewing replaces.
  Names names;
  Colors colors;
  for (TopExp_Explorer it(walk.loose, TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_TShape *before = it.Current().TShape().get();
    const TopoDS_TShape *after = sewing.ModifiedSubShape(it.Current()).TShape().get();
    const auto named = walk.solid_names.find(before);
    if (named != walk.solid_names.end()) names.insert({after, named->second});
    const auto colored = walk.colors.find(before);
    if (colored != walk.colors.end()) colors.insert({after, colored->second});
  }
  BRep_Builder builder;
  TopoDS_Compound closed;
  builder.MakeCompound(closed);
  bool any = false;
  const auto add_closed = [&](const TopoDS_Shape &shell) {
    // Surfaces that close but enclose nothing are no solids.
    if (!BRep_Tool::IsClosed(shell) || !encloses_volume(shell)) return;
    builder.Add(closed, shell);
    any = true;
  };
  for (TopExp_Explorer it(sewing.SewedShape(), TopAbs_SHELL); it.More(); it.Next())
    add_closed(it.Current());
  // A closed face of its own is no shell.
  for (TopExp_Explorer it(sewing.SewedShape(), TopAbs_FACE, TopAbs_SHELL); it.More(); it.Next()) {
    TopoDS_Shell shell;
    builder.MakeShell(shell);
    builder.Add(shell, it.Current());
    add_closed(shell);
  }
  if (!any) return;
  for (const TopoDS_Solid &solid : solids_of_shells(closed)) {
    Part part;
    part.solid = solid;
    const Color *color = face_color(solid, colors);
    part.has_color = color != nullptr;
    for (int i = 0; color && i < 3; ++i) part.color[i] = linear(color->channels[i]);
    for (TopExp_Explorer it(solid, TopAbs_FACE); it.More() && part.name.empty(); it.Next()) {
      const auto named = names.find(it.Current().TShape().get());
      if (named != names.end()) part.name = named->second;
    }
    part.solid = unify({solid})[0];
    walk.parts.push_back(part);
  }
}

static std::string read_path(Reader &in) {
  const std::string path = in.text();
  in.finish();
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw Failure{CAG_BREP_FAIL_FILE, "cannot read `" + path + "`: " + std::strerror(errno)};
  if (file.peek() == std::ifstream::traits_type::eof())
    throw Failure{CAG_BREP_FAIL_FILE, "cannot read `" + path + "`: it is empty or no file"};
  return path;
}

// A file that the kernel does not read: damaged if it begins as such files do. STEP files begin with
// their standard, lines of IGES files have the letter of their section in column 73.
static Failure unreadable(const std::string &path, const char *kind) {
  std::ifstream file(path, std::ios::binary);
  std::string start(80, ' ');
  file.read(&start[0], static_cast<std::streamsize>(start.size()));
  const bool step = start.find("ISO-10303-21") != std::string::npos, iges = start[72] == 'S';
  if (kind == std::string("a STEP file") ? step : iges && !step)
    return {CAG_BREP_FAIL_FILE, "`" + path +
                                    "` is damaged: it is not complete, or not written as " + kind +
                                    " must be"};
  return {CAG_BREP_FAIL_FILE, "`" + path + "` is not " + kind};
}

static std::vector<Part> finish_walk(Walk &walk, double gap) {
  add_loose(walk, gap);
  if (walk.parts.empty()) throw Failure{CAG_BREP_FAIL_FILE, "the file has no solids"};
  return walk.parts;
}

// ---- STEP ----

static bool decode_color(const Ref<StepVisual_Colour> &colour, Color &color) {
  if (colour.IsNull()) return false;
  if (const auto rgb = Ref<StepVisual_ColourRgb>::DownCast(colour)) {
    color = {{rgb->Red(), rgb->Green(), rgb->Blue()}};
    return true;
  }
  // A name of the standard: pure red, green, blue, yellow, magenta, cyan, black, or white, which are
  // the same in any encoding.
  Quantity_Color named;
  if (!STEPConstruct_Styles::DecodeColor(colour, named)) return false;
  color = {{named.Red(), named.Green(), named.Blue()}};
  return true;
}

static Colors step_colors(const Ref<XSControl_WorkSession> &session,
                          const Ref<Transfer_TransientProcess> &process) {
  Colors colors;
  STEPConstruct_Styles styles(session);
  if (!styles.LoadStyles()) return colors;
  for (int i = 1; i <= styles.NbStyles(); ++i) {
    const Ref<StepVisual_StyledItem> style = styles.Style(i);
    if (style.IsNull()) continue;
    Ref<StepVisual_Colour> surface, boundary, curve, rendered;
    double transparency = 0;
    Standard_Boolean component = Standard_False;
    if (!styles.GetColors(style, surface, boundary, curve, rendered, transparency, component))
      continue;
    Color color;
    if (!decode_color(rendered.IsNull() ? surface : rendered, color)) continue;
    const Ref<StepRepr_RepresentationItem> item = style->Item();
    if (item.IsNull()) continue;
    const TopoDS_Shape shape = STEPConstruct::FindShape(process, item);
    if (!shape.IsNull()) colors.insert({shape.TShape().get(), color});
  }
  return colors;
}

static bool has_faces(const TopoDS_Shape &shape) {
  return !shape.IsNull() && TopExp_Explorer(shape, TopAbs_FACE).More();
}

// Parts in other files would be missing without notice. Files of parts that are here as well, such as
// drawings, do not matter.
static void refuse_other_files(const Ref<XSControl_WorkSession> &session,
                               const Ref<Transfer_TransientProcess> &process) {
  STEPConstruct_ExternRefs references(session);
  std::set<std::string> files;
  if (!references.LoadExternRefs()) return;
  for (int i = 1; i <= references.NbExternRefs(); ++i) {
    const char *file = references.FileName(i);
    const Ref<StepBasic_ProductDefinition> part = references.ProdDef(i);
    if (!file || !*file || part.IsNull()) continue;
    if (!has_faces(TransferBRep::ShapeResult(process, part))) files.insert(file);
  }
  if (files.empty()) return;
  std::string names;
  const size_t most = 5;
  size_t n = 0;
  for (const std::string &file : files) {
    if (n == most) names += " ...";
    if (n++ >= most) break;
    names += (names.empty() ? "`" : ", `") + file + "`";
  }
  throw Failure{CAG_BREP_FAIL_FILE,
                "its parts are in other files, which must be read by themselves: " + names};
}

std::vector<Part> read_step(Reader &in) {
  const std::string path = read_path(in);
  STEPControl_Reader reader;
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) throw unreadable(path, "a STEP file");
  reader.TransferRoots();
  const Ref<XSControl_WorkSession> session = reader.WS();
  const Ref<Transfer_TransientProcess> process = session->TransferReader()->TransientProcess();
  const Ref<Interface_InterfaceModel> model = session->Model();
  refuse_other_files(session, process);

  Names solid_names, product_names;
  std::set<const void *> products;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Ref<Standard_Transient> entity = model->Value(i);
    if (const auto item = Ref<StepRepr_RepresentationItem>::DownCast(entity)) {
      const std::string name = text_of(item->Name());
      if (name.empty()) continue;
      const TopoDS_Shape shape = TransferBRep::ShapeResult(process, item);
      if (!shape.IsNull() &&
          (shape.ShapeType() == TopAbs_SOLID || shape.ShapeType() == TopAbs_SHELL))
        solid_names.insert({shape.TShape().get(), name});
    } else if (const auto definition = Ref<StepBasic_ProductDefinition>::DownCast(entity)) {
      if (definition->Formation().IsNull() || definition->Formation()->OfProduct().IsNull())
        continue;
      const Ref<StepBasic_Product> product = definition->Formation()->OfProduct();
      products.insert(product.get());
      std::string name = text_of(product->Name());
      if (name.empty()) name = text_of(product->Id());
      const TopoDS_Shape shape = TransferBRep::ShapeResult(process, definition);
      if (!shape.IsNull()) product_names.insert({shape.TShape().get(), name});
    }
  }
  const Colors colors = step_colors(session, process);
  Walk walk = {solid_names, product_names, colors, products.size() > 1, {}, {}, {}};
  for (int i = 1; i <= reader.NbShapes(); ++i) { walk.visit(reader.Shape(i), "", nullptr, false); }
  return finish_walk(walk, 1e-6);
}

// ---- IGES ----

static bool iges_color(const Ref<IGESData_IGESEntity> &entity, Color &color) {
  // Predefined colors 1 to 8 (IGES 5.3, 2.2.4.4.13).
  static const Color predefined[9] = {{{0, 0, 0}}, {{0, 0, 0}}, {{1, 0, 0}},
                                      {{0, 1, 0}}, {{0, 0, 1}}, {{1, 1, 0}},
                                      {{1, 0, 1}}, {{0, 1, 1}}, {{1, 1, 1}}};
  if (const auto defined = Ref<IGESGraph_Color>::DownCast(entity->Color())) {
    double r, g, b;
    defined->RGBIntensity(r, g, b);
    color = {{r / 100, g / 100, b / 100}};
    return true;
  }
  const int rank = entity->RankColor();
  if (rank < 1 || rank > 8) return false;
  color = predefined[rank];
  return true;
}

std::vector<Part> read_iges(Reader &in) {
  const std::string path = read_path(in);
  IGESControl_Reader reader;
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) throw unreadable(path, "an IGES file");
  reader.TransferRoots();
  const Ref<Transfer_TransientProcess> process = reader.WS()->TransferReader()->TransientProcess();
  const Ref<Interface_InterfaceModel> model = reader.WS()->Model();
  Names names;
  const Names products;
  Colors colors;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto entity = Ref<IGESData_IGESEntity>::DownCast(model->Value(i));
    if (entity.IsNull()) continue;
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process, entity);
    if (shape.IsNull()) continue;
    std::string name = entity->HasName() ? text_of(entity->NameValue()) : "";
    if (name.empty() && entity->HasShortLabel()) name = text_of(entity->ShortLabel());
    Color color;
    const bool has_color = iges_color(entity, color);
    if (!name.empty()) names.insert({shape.TShape().get(), name});
    if (has_color) colors.insert({shape.TShape().get(), color});
  }
  Walk walk = {names, products, colors, false, {}, {}, {}};
  for (int i = 1; i <= reader.NbShapes(); ++i) walk.visit(reader.Shape(i), "", nullptr, false);
  return finish_walk(walk, IGES_GAP);
}

} // namespace brep
