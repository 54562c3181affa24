// Reads the text of a URDF file as links and joints.
//
// libxml2 parses the XML, with its limits on depth and on the length of names and texts.

#include "interp/formats/urdf_read.h"
#include "base/memory.h"

#include <libxml/parser.h>
#include <libxml/tree.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "interp/formats/text_scan.h"

// Descriptions of robots have at most a few hundred kilobytes, because shapes are in separate
// files. The tree of the XML takes about thirty times the size of its text.
#define FILE_MOST ((size_t)16 << 20)
// Names are compared pairwise.
#define LINKS_MOST 4096
#define BODIES_MOST 16384

#define MILLIMETERS 1000.0
// Meters: the range of sizes of robots.
#define LENGTH_LEAST 1e-9
#define LENGTH_MOST 1e9

typedef struct NamedColor {
  const char *name;
  CagColor color;
  double alpha;
} NamedColor;

typedef struct Reader {
  CagUrdfTree *tree;
  CagError *err;
  CagStatus status;
  xmlParserCtxtPtr context;
  const xmlDoc *document;
  NamedColor *colors;
  size_t color_count, color_room, node_room, edge_room, body_count;
} Reader;

// --- Errors ---

static CagStatus fail_at(Reader *r, CagErrorId id, long line, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
static CagStatus fail_at(Reader *r, CagErrorId id, long line, const char *format, ...) {
  char message[300];
  va_list args;
  if (r->status) return r->status; // only the first error is reported
  va_start(args, format);
  vsnprintf(message, sizeof message, format, args);
  va_end(args);
  return r->status = cag_fail(r->err, CAG_E_ARGUMENT, id, "path", line, "%s, line %ld: %s",
                              r->tree->file, line, message);
}

#define SYNTAX CAG_ERR_urdf_syntax

// --- Attributes ---

static bool is_element(const xmlNode *n, const char *name) {
  return n->type == XML_ELEMENT_NODE && xmlStrEqual(n->name, (const xmlChar *)name);
}

static const xmlNode *child(const xmlNode *n, const char *name) {
  for (const xmlNode *c = n->children; c; c = c->next)
    if (is_element(c, name)) return c;
  return NULL;
}

static void free_text(void *text) { xmlFree(text); }

// Returns a copy in the arena, or NULL if there is no such attribute.
static const char *attribute(Reader *r, const xmlNode *n, const char *name) {
  xmlChar *text = xmlGetNoNsProp((xmlNode *)n, (const xmlChar *)name);
  if (!text) return NULL;
  CagCleanup cleanup;
  cag_cleanup_push(&cleanup, free_text, text);
  char *copy = cag_arena_copy(&r->tree->arena, (const char *)text, strlen((const char *)text));
  cag_cleanup_run(&cleanup);
  return copy;
}

static const char *wanted(Reader *r, const xmlNode *n, const char *name) {
  const char *text = attribute(r, n, name);
  if (text && *text) return text;
  fail_at(r, SYNTAX, xmlGetLineNo((xmlNode *)n), "<%.40s> lacks its %s", (const char *)n->name,
          name);
  return "";
}

// Reads n finite numbers of an attribute. Returns false, and leaves `out` unchanged, if it is
// missing.
static bool numbers(Reader *r, const xmlNode *node, const char *name, double *out, int n) {
  const char *text = node ? attribute(r, node, name) : NULL;
  if (!text) return false;
  CagTextScan s = {text, text + strlen(text)};
  double x[4] = {0};
  for (int i = 0; i < n; i++) {
    if (cag_scan_to_word(&s) && cag_scan_number(&s, &x[i]) && isfinite(x[i])) continue;
    bool macro = strstr(text, "${") != NULL;
    fail_at(r, SYNTAX, xmlGetLineNo((xmlNode *)node), "%s=\"%.60s\" of <%.40s> is not %s%s", name,
            text, (const char *)node->name,
            n == 1   ? "a finite number"
            : n == 3 ? "three finite numbers"
                     : "four finite numbers",
            macro ? "; this is xacro: expand it to a .urdf file first (ros2 run xacro xacro)" : "");
    return false;
  }
  if (cag_scan_to_word(&s))
    fail_at(r, SYNTAX, xmlGetLineNo((xmlNode *)node), "%s=\"%.60s\" has more than %d numbers", name,
            text, n);
  memcpy(out, x, (size_t)n * sizeof *x);
  return true;
}

// The same for lengths in meters and for scale factors. Values above LENGTH_MOST are errors.
static bool lengths(Reader *r, const xmlNode *node, const char *name, double *out, int n) {
  if (!numbers(r, node, name, out, n)) return false;
  for (int i = 0; i < n; i++)
    if (fabs(out[i]) > LENGTH_MOST)
      fail_at(r, SYNTAX, xmlGetLineNo((xmlNode *)node), "%s of <%.40s> is out of range: %g", name,
              (const char *)node->name, out[i]);
  return !r->status;
}

// --- Common elements ---

static CagTransform origin_of(Reader *r, const xmlNode *owner) {
  double xyz[3] = {0}, rpy[3] = {0};
  const xmlNode *n = child(owner, "origin");
  lengths(r, n, "xyz", xyz, 3);
  numbers(r, n, "rpy", rpy, 3);
  CagTransform t = cag_rpy(rpy[0], rpy[1], rpy[2]);
  for (int i = 0; i < 3; i++) t.m[i][3] = xyz[i] * MILLIMETERS;
  t.planar = false;
  return t;
}

static CagColor linear(const double rgba[4]) {
  double c[3];
  for (int i = 0; i < 3; i++) c[i] = cag_srgb_to_linear(fmin(fmax(rgba[i], 0), 1));
  return (CagColor){c[0], c[1], c[2]};
}

static void *grown(Reader *r, void *items, size_t count, size_t *room, size_t size) {
  if (count < *room) return items;
  size_t more = *room ? 2 * *room : 16;
  void *bigger = cag_arena_alloc(&r->tree->arena, more * size);
  if (count) memcpy(bigger, items, count * size);
  *room = more;
  return bigger;
}

// A material with a color is then known by its name, wherever it was defined.
static void read_material(Reader *r, const xmlNode *n, CagUrdfBody *body) {
  double rgba[4] = {0, 0, 0, 1};
  const char *name = attribute(r, n, "name");
  if (body) body->material = name;
  if (!numbers(r, child(n, "color"), "rgba", rgba, 4)) return;
  NamedColor c = {name ? name : "", linear(rgba), fmin(fmax(rgba[3], 0), 1)};
  if (body) {
    body->colored = true;
    body->color = c.color;
    body->alpha = c.alpha;
  }
  if (!name || r->color_count >= LINKS_MOST) return;
  r->colors = grown(r, r->colors, r->color_count, &r->color_room, sizeof *r->colors);
  r->colors[r->color_count++] = c;
}

// --- Links ---

static void read_geometry(Reader *r, const xmlNode *n, CagUrdfBody *b) {
  const xmlNode *g;
  double *size = b->size;
  bool sized = true;
  if ((g = child(n, "mesh"))) {
    b->kind = CAG_URDF_BODY_MESH;
    b->file = wanted(r, g, "filename");
    for (int i = 0; i < 3; i++) b->scale[i] = 1;
    lengths(r, g, "scale", b->scale, 3);
    for (int i = 0; i < 3; i++)
      if (fabs(b->scale[i]) < LENGTH_LEAST)
        fail_at(r, SYNTAX, b->line, "the scale of a mesh must not be 0");
    return;
  }
  if ((g = child(n, "box"))) {
    b->kind = CAG_URDF_BODY_BOX;
    sized = lengths(r, g, "size", size, 3) && size[0] > LENGTH_LEAST && size[1] > LENGTH_LEAST &&
            size[2] > LENGTH_LEAST;
  } else if ((g = child(n, "cylinder"))) {
    b->kind = CAG_URDF_BODY_CYLINDER;
    sized = lengths(r, g, "radius", &size[0], 1) && lengths(r, g, "length", &size[1], 1) &&
            size[0] > LENGTH_LEAST && size[1] > LENGTH_LEAST;
  } else if ((g = child(n, "sphere"))) {
    b->kind = CAG_URDF_BODY_SPHERE;
    sized = lengths(r, g, "radius", &size[0], 1) && size[0] > LENGTH_LEAST;
  } else {
    fail_at(r, SYNTAX, b->line, "<geometry> contains no mesh, box, cylinder, or sphere");
  }
  if (!sized)
    fail_at(r, SYNTAX, xmlGetLineNo((xmlNode *)g), "<%s> lacks sizes greater than 0",
            (const char *)g->name);
  for (int i = 0; i < 3; i++) size[i] *= MILLIMETERS;
}

static CagUrdfBody *read_body(Reader *r, const xmlNode *n) {
  CagUrdfBody *b = cag_arena_alloc(&r->tree->arena, sizeof *b);
  b->line = xmlGetLineNo((xmlNode *)n);
  if (++r->body_count > BODIES_MOST)
    fail_at(r, SYNTAX, b->line, "there are more than %d bodies", BODIES_MOST);
  b->place = origin_of(r, n);
  const xmlNode *geometry = child(n, "geometry"), *material = child(n, "material");
  if (geometry) read_geometry(r, geometry, b);
  else fail_at(r, SYNTAX, b->line, "<%s> lacks its <geometry>", (const char *)n->name);
  if (material) read_material(r, material, b);
  return b;
}

static void read_link(Reader *r, const xmlNode *n) {
  CagUrdfTree *t = r->tree;
  CagUrdfNode link = {.line = xmlGetLineNo((xmlNode *)n), .above = CAG_URDF_NONE};
  link.name = wanted(r, n, "name");
  CagUrdfBody **visual = &link.visuals, **collision = &link.collisions;
  if (t->node_count >= LINKS_MOST)
    fail_at(r, SYNTAX, link.line, "there are more than %d links", LINKS_MOST);
  for (size_t i = 0; i < t->node_count; i++)
    if (!strcmp(t->nodes[i].name, link.name))
      fail_at(r, CAG_ERR_urdf_chain, link.line,
              "a second link is named \"%.60s\"; the first one is in line %ld", link.name,
              t->nodes[i].line);
  for (const xmlNode *c = n->children; c && !r->status; c = c->next) {
    bool seen = is_element(c, "visual");
    if (!seen && !is_element(c, "collision")) continue;
    CagUrdfBody ***last = seen ? &visual : &collision;
    **last = read_body(r, c);
    *last = &(**last)->next;
  }
  t->nodes = grown(r, t->nodes, t->node_count, &r->node_room, sizeof *t->nodes);
  t->nodes[t->node_count++] = link;
}

// --- Joints ---

static size_t find_node(const CagUrdfTree *t, const char *name) {
  for (size_t i = 0; i < t->node_count; i++)
    if (!strcmp(t->nodes[i].name, name)) return i;
  return CAG_URDF_NONE;
}

static size_t joint_end(Reader *r, const xmlNode *joint, const char *which, const char *name) {
  long line = xmlGetLineNo((xmlNode *)joint);
  const xmlNode *n = child(joint, which);
  if (!n) {
    fail_at(r, SYNTAX, line, "the joint \"%.60s\" lacks its <%s>", name, which);
    return 0;
  }
  const char *link = wanted(r, n, "link");
  size_t i = find_node(r->tree, link);
  if (i == CAG_URDF_NONE)
    fail_at(r, CAG_ERR_urdf_chain, xmlGetLineNo((xmlNode *)n),
            "the joint \"%.60s\" refers to the link \"%.60s\", which does not exist", name, link);
  return i;
}

static void read_limits(Reader *r, const xmlNode *n, CagUrdfEdge *e) {
  const double turn = 2 * M_PI;
  const xmlNode *l = child(n, "limit");
  bool slides = e->kind == CAG_URDF_PRISMATIC;
  double unit = slides ? MILLIMETERS : 1;
  if (!l && e->kind != CAG_URDF_CONTINUOUS)
    fail_at(r, SYNTAX, e->line, "the joint \"%.60s\" lacks its <limit>, which %s %s joint needs",
            e->name, cag_article(slides ? "prismatic" : "revolute"),
            slides ? "prismatic" : "revolute");
  numbers(r, l, "lower", &e->low, 1);
  numbers(r, l, "upper", &e->high, 1);
  numbers(r, l, "velocity", &e->speed, 1);
  numbers(r, l, "effort", &e->effort, 1);
  e->low *= unit;
  e->high *= unit;
  e->speed = fmax(0, e->speed * unit);
  e->effort = fmax(0, e->effort);
  if (e->kind == CAG_URDF_CONTINUOUS) e->low = -turn, e->high = turn;
  if (e->low > e->high)
    fail_at(r, CAG_ERR_joint_limits, e->line,
            "the joint \"%.60s\" has its lower limit above the upper one", e->name);
}

static void read_axis(Reader *r, const xmlNode *n, CagUrdfEdge *e) {
  double x[3] = {1, 0, 0};
  numbers(r, child(n, "axis"), "xyz", x, 3);
  e->axis = cag_unit(cag_vec3(x[0], x[1], x[2]));
  if (!(cag_norm(e->axis) > 0))
    fail_at(r, SYNTAX, e->line, "the joint \"%.60s\" has a zero vector as its axis", e->name);
}

static void read_mimic(Reader *r, const xmlNode *n, CagUrdfEdge *e) {
  const xmlNode *m = child(n, "mimic");
  e->multiplier = 1;
  if (!m) return;
  e->mimic = wanted(r, m, "joint");
  numbers(r, m, "multiplier", &e->multiplier, 1);
  numbers(r, m, "offset", &e->offset, 1);
}

static void read_joint(Reader *r, const xmlNode *n) {
  static const char *const kinds[] = {"revolute", "continuous", "prismatic",
                                      "fixed",    "floating",   "planar"};
  CagUrdfTree *t = r->tree;
  CagUrdfEdge e = {.line = xmlGetLineNo((xmlNode *)n)};
  e.name = wanted(r, n, "name");
  const char *type = wanted(r, n, "type");
  size_t kind = 0, most = sizeof kinds / sizeof *kinds;
  while (kind < most && strcmp(kinds[kind], type) != 0) kind++;
  if (kind == most)
    fail_at(
        r, CAG_ERR_urdf_joint, e.line,
        "the joint \"%.60s\" has the unknown type \"%.60s\"; the types are revolute, continuous, prismatic, fixed, floating, and planar",
        e.name, type);
  e.kind = (CagUrdfJointKind)kind;
  e.origin = origin_of(r, n);
  e.parent = joint_end(r, n, "parent", e.name);
  e.child = joint_end(r, n, "child", e.name);
  if (e.kind <= CAG_URDF_PRISMATIC) {
    read_axis(r, n, &e);
    read_limits(r, n, &e);
    read_mimic(r, n, &e);
  }
  if (r->status) return;
  CagUrdfNode *below = &t->nodes[e.child];
  if (below->above != CAG_URDF_NONE) {
    fail_at(r, CAG_ERR_urdf_chain, e.line,
            "the link \"%.60s\" has two parent joints, \"%.60s\" and \"%.60s\"", below->name,
            t->edges[below->above].name, e.name);
    return;
  }
  below->above = t->edge_count;
  t->edges = grown(r, t->edges, t->edge_count, &r->edge_room, sizeof *t->edges);
  t->edges[t->edge_count++] = e;
}

// --- The document ---

// Finds the colors of materials that are given only by name.
static void find_colors(Reader *r) {
  for (size_t i = 0; i < r->tree->node_count; i++)
    for (CagUrdfBody *b = r->tree->nodes[i].visuals; b; b = b->next)
      for (size_t k = 0; k < r->color_count && b->material && !b->colored; k++) {
        if (strcmp(r->colors[k].name, b->material) != 0) continue;
        b->colored = true;
        b->color = r->colors[k].color;
        b->alpha = r->colors[k].alpha;
      }
}

static void each(Reader *r, const xmlNode *root, const char *name,
                 void (*read)(Reader *r, const xmlNode *n)) {
  for (const xmlNode *n = root->children; n && !r->status; n = n->next)
    if (is_element(n, name)) read(r, n);
}

static void read_named_material(Reader *r, const xmlNode *n) { read_material(r, n, NULL); }

static void read_document(Reader *r, const xmlDoc *doc) {
  const xmlNode *root = xmlDocGetRootElement((xmlDoc *)doc);
  if (!root || !is_element(root, "robot")) {
    fail_at(r, SYNTAX, root ? xmlGetLineNo((xmlNode *)root) : 1,
            "<robot> must be the outermost element, found <%.40s>",
            root ? (const char *)root->name : "");
    return;
  }
  const char *name = attribute(r, root, "name");
  r->tree->name = name ? name : "";
  each(r, root, "material", read_named_material);
  each(r, root, "link", read_link);
  each(r, root, "joint", read_joint);
  find_colors(r);
  if (r->tree->node_count == 0)
    fail_at(r, SYNTAX, xmlGetLineNo((xmlNode *)root), "the robot has no links");
}

// Entities are defined in a document type, so reading stops at its start.
static void refuse_document_type(void *context, const xmlChar *name, const xmlChar *external,
                                 const xmlChar *system) {
  xmlParserCtxtPtr parser = context;
  Reader *r = parser->_private;
  (void)name, (void)external, (void)system;
  fail_at(r, SYNTAX, parser->input ? parser->input->line : 1,
          "a document type (<!DOCTYPE ...>) is not allowed; remove it");
  xmlStopParser(parser);
}

static void read_tree(void *context) {
  Reader *r = context;
  read_document(r, r->document);
}

// Returns the maximum memory that libxml2 needs for a file, from the number of characters at which
// nodes, attributes, and texts start.
static size_t tree_bytes(const char *bytes, size_t size) {
  enum { NODE = 256, ATTRIBUTE = 384 };
  size_t total = 3 * size;
  for (size_t i = 0; i < size; i++)
    total += bytes[i] == '<' ? 2 * NODE : bytes[i] == '=' ? ATTRIBUTE : 0;
  return total;
}

static void parse_document(Reader *r, const char *bytes, size_t size) {
  r->context->_private = r;
  r->context->sax->internalSubset = refuse_document_type;
  xmlDoc *doc = xmlCtxtReadMemory(r->context, bytes, (int)size, NULL, NULL,
                                  XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING |
                                      XML_PARSE_BIG_LINES | XML_PARSE_NOCDATA);
  const xmlError *fault = xmlCtxtGetLastError(r->context);
  r->document = doc;
  if (doc && !r->status && !cag_memory_guard(read_tree, r)) r->status = cag_fail_memory(r->err);
  if (!doc && !r->status) {
    const char *told = fault && fault->message ? fault->message : "no XML";
    fail_at(r, SYNTAX, fault ? fault->line : 1, "%.*s", (int)strcspn(told, "\n"), told);
  }
  xmlFreeDoc(doc);
}

static void parse(Reader *r, const char *bytes, size_t size) {
  const size_t held = tree_bytes(bytes, size);
  if (!cag_account_hold(held)) {
    r->status = cag_fail_memory(r->err);
    return;
  }
  parse_document(r, bytes, size);
  cag_account_drop(held);
}

static pthread_once_t begun = PTHREAD_ONCE_INIT;

CagStatus cag_urdf_read(const char *file, const char *bytes, size_t size, CagUrdfTree *out,
                        CagError *err) {
  *out = (CagUrdfTree){.file = file, .name = ""};
  Reader r = {.tree = out, .err = err, .status = CAG_OK};
  if (size > FILE_MOST)
    return fail_at(&r, SYNTAX, 1, "the file has %zu MiB, more than the limit of 16 MiB",
                   size >> 20);
  pthread_once(&begun, xmlInitParser);
  r.context = xmlNewParserCtxt();
  if (!r.context) return cag_fail_memory(err);
  parse(&r, bytes, size);
  xmlFreeParserCtxt(r.context);
  return r.status;
}

void cag_urdf_tree_free(CagUrdfTree *t) { cag_arena_free(&t->arena); }
