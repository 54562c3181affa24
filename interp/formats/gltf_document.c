// Parsing of a glTF document: its JSON, its buffers, and typed views of them.
//
// Buffers are the binary chunk of a GLB, base64 text in the document, or separate files. Views and
// accessors are checked against the buffers with integer arithmetic, so that reading through them
// needs no checks. JSON is parsed by cJSON. The memory of its tree is estimated in advance from the
// number of commas and brackets.

#include "interp/formats/gltf_document.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/aside.h"
#include "base/memory.h"
#include "base/stop.h"

enum { GLB_HEADER = 12, CHUNK_HEADER = 8 };
#define JSON_CHUNK 0x4e4f534au
#define BINARY_CHUNK 0x004e4942u
// Bytes of one value in cJSON's tree, including the overhead of the allocator.
#define JSON_VALUE_BYTES 96
// Integers up to this are exact in JSON's doubles.
#define WHOLE_MOST 9007199254740992.0

// Component types of the specification.
enum { BYTE = 5120, UBYTE, SHORT, USHORT, UINT = 5125, FLOAT };

CagStatus(cag_gltf_fail)(const CagGltf *g, CagError *err, CagErrorId id, const char *format, ...) {
  char message[250];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  return cag_mesh_file_fail_byte(g->draft->file, err, id, NULL, "%s", message);
}

bool cag_gltf_whole(const cJSON *object, const char *key, size_t fallback, size_t *out) {
  const cJSON *v = cJSON_GetObjectItemCaseSensitive(object, key);
  *out = fallback;
  if (!v) return true;
  if (!cJSON_IsNumber(v)) return false;
  double x = v->valuedouble;
  if (!(x >= 0 && x <= WHOLE_MOST) || x != floor(x)) return false;
  *out = (size_t)x;
  return true;
}

// --- JSON ---

// Larger texts take cJSON so long that they must be interruptible.
#define LARGE_JSON ((size_t)1 << 20)

typedef struct Parsing {
  const char *text; // followed by its copy, if it is large
  size_t n, end;    // position at which the parser stopped
  cJSON *json;
} Parsing;

static void parse(void *data) {
  Parsing *p = data;
  const char *end = NULL;
  p->json = cJSON_ParseWithLengthOpts(p->text, p->n, &end, false);
  p->end = end && end > p->text ? (size_t)(end - p->text) : 0;
}

static void free_parsing(void *data) {
  cJSON_Delete(((Parsing *)data)->json);
  free(data);
}

// A large text is parsed on another thread, so that the work can be stopped.
static CagStatus run_parser(CagGltf *g, const char *text, size_t n, size_t *end, CagError *err) {
  const bool large = n >= LARGE_JSON;
  CagStatus status = large ? cag_draft_take(g->draft, n, 1, err) : CAG_OK;
  Parsing *p = !status ? malloc(sizeof *p + (large ? n : 0)) : NULL;
  if (!p) return !status ? cag_fail_memory(err) : status;
  *p = (Parsing){.text = text, .n = n};
  if (large) p->text = memcpy(p + 1, text, n);
  if (!large) parse(p);
  else if (!cag_run_aside(parse, free_parsing, p)) return cag_stop_fail(err);
  g->json = p->json;
  *end = p->end;
  free(p);
  return CAG_OK;
}

static CagStatus parse_json(CagGltf *g, const char *text, size_t n, CagError *err) {
  size_t values = 1;
  long depth = 0;
  bool quoted = false;
  for (size_t i = 0; i < n; i++) {
    if (quoted) {
      if (text[i] == '\\') i++;
      else if (text[i] == '"') quoted = false;
    } else if (text[i] == '"') quoted = true;
    else {
      bool opens = text[i] == '[' || text[i] == '{', closes = text[i] == ']' || text[i] == '}';
      values += opens || text[i] == ',';
      depth += opens - closes;
    }
  }
  CagStatus status = cag_draft_take(g->draft, values, JSON_VALUE_BYTES, err);
  if (!status) status = cag_draft_take(g->draft, n, 1, err);
  size_t at = 0;
  if (!status) status = run_parser(g, text, n, &at, err);
  if (status) return status;
  if (g->json && cJSON_IsObject(g->json)) return CAG_OK;
  bool ended = quoted || depth > 0;
  return cag_mesh_file_fail_line(
      g->draft->file, err, ended ? CAG_ERR_mesh_file_truncated : CAG_ERR_mesh_file_syntax,
      text + at, "the JSON of the file cannot be read%s",
      ended ? ": it is incomplete; write or download the file again" : "");
}

static CagStatus read_array(CagGltf *g, const char *key, CagGltfArray *out, CagError *err) {
  const cJSON *array = cJSON_GetObjectItemCaseSensitive(g->json, key), *item;
  if (!array) return CAG_OK;
  if (!cJSON_IsArray(array))
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_syntax, "`%s` is not an array", key);
  size_t n = 0;
  cJSON_ArrayForEach(item, array) n++;
  CagStatus status = cag_draft_take(g->draft, n + 1, sizeof *out->items, err);
  if (status) return status;
  out->items = cag_malloc((n + 1) * sizeof *out->items);
  if (!out->items) return cag_fail_memory(err);
  cJSON_ArrayForEach(item, array) {
    if (!cJSON_IsObject(item))
      return cag_gltf_fail(g, err, CAG_ERR_mesh_file_syntax, "%s[%zu] is not an object", key,
                           out->count);
    out->items[out->count++] = item;
  }
  return CAG_OK;
}

// Splits a GLB into its chunks. A JSON file is a single chunk.
static CagStatus find_chunks(CagGltf *g, const char **json, size_t *json_size,
                             CagGltfBuffer *binary, CagError *err) {
  const CagMeshFile *f = g->draft->file;
  *json = f->bytes;
  *json_size = f->size;
  if (f->size < 4 || memcmp(f->bytes, "glTF", 4) != 0) return CAG_OK;
  const char *text = NULL;
  if (f->size < GLB_HEADER || cag_read_u32(f->bytes + 8) > f->size)
    return cag_gltf_fail(
        g, err, CAG_ERR_mesh_file_truncated,
        "it has %zu bytes of the %lu that its header states; write or download it again", f->size,
        f->size < GLB_HEADER ? (unsigned long)GLB_HEADER
                             : (unsigned long)cag_read_u32(f->bytes + 8));
  if (cag_read_u32(f->bytes + 4) != 2)
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_unsupported,
                         "it is GLB of version %lu; write it as glTF 2.0",
                         (unsigned long)cag_read_u32(f->bytes + 4));
  for (size_t at = GLB_HEADER; f->size - at >= CHUNK_HEADER;) {
    size_t size = cag_read_u32(f->bytes + at);
    uint32_t kind = cag_read_u32(f->bytes + at + 4);
    at += CHUNK_HEADER;
    if (size > f->size - at)
      return cag_mesh_file_fail_byte(
          f, err, CAG_ERR_mesh_file_truncated, f->bytes + at,
          "a chunk has %zu bytes, but only %zu are left; write or download the file again", size,
          f->size - at);
    if (kind == JSON_CHUNK && !text) text = f->bytes + at, *json_size = size;
    if (kind == BINARY_CHUNK && !binary->bytes)
      *binary = (CagGltfBuffer){(char *)f->bytes + at, size, false};
    at += size;
  }
  if (!text) return cag_gltf_fail(g, err, CAG_ERR_mesh_file_syntax, "it has no JSON chunk");
  *json = text;
  return CAG_OK;
}

// --- Buffers ---

static int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  return c == '/' || c == '_' ? 63 : -1;
}

static CagStatus decode_base64(CagGltf *g, const char *text, CagGltfBuffer *b, CagError *err) {
  size_t n = strlen(text);
  CagStatus status = cag_draft_take(g->draft, n / 4 + 1, 3, err);
  if (status) return status;
  b->bytes = cag_malloc(n / 4 * 3 + 4);
  b->owned = true;
  if (!b->bytes) return cag_fail_memory(err);
  uint32_t bits = 0;
  int have = 0;
  for (size_t i = 0; i < n && text[i] != '='; i++) {
    int digit = base64_digit(text[i]);
    if (digit < 0)
      return cag_gltf_fail(g, err, CAG_ERR_mesh_file_syntax,
                           "a buffer's base64 has the character 0x%02x",
                           (unsigned)(unsigned char)text[i]);
    bits = bits << 6 | (uint32_t)digit;
    have += 6;
    if (have < 8) continue;
    have -= 8;
    b->bytes[b->size++] = (char)(bits >> have & 0xff);
  }
  return CAG_OK;
}

static int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// Decodes %XX in a relative path. Returns it allocated with malloc.
static char *decode_path(const char *uri) {
  char *path = cag_strdup(uri), *to = path;
  for (const char *at = path; at && *at; at++) {
    int high = *at == '%' ? hex_digit(at[1]) : -1, low = high >= 0 ? hex_digit(at[2]) : -1;
    if (low >= 0 && 16 * high + low > 0) {
      *to++ = (char)(16 * high + low);
      at += 2;
    } else *to++ = *at;
  }
  if (to) *to = 0;
  return path;
}

static CagStatus open_buffer(CagGltf *g, const char *uri, CagGltfBuffer *b, CagError *err) {
  if (strncasecmp(uri, "data:", 5) == 0) {
    const char *comma = strchr(uri, ',');
    if (!comma || comma - uri < 7 || strncasecmp(comma - 7, ";base64", 7) != 0)
      return cag_gltf_fail(g, err, CAG_ERR_mesh_file_unsupported,
                           "a buffer in the file is not base64");
    return decode_base64(g, comma + 1, b, err);
  }
  const CagMeshFile *f = g->draft->file;
  if (strstr(uri, "://") || !f->open)
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_unsupported,
                         "a buffer is at %.100s; put it into a file next to this one", uri);
  char *path = decode_path(uri);
  if (!path) return cag_fail_memory(err);
  CagStatus status = f->open(f->context, path, &b->bytes, &b->size, err);
  cag_free(path);
  b->owned = !status;
  if (!status) status = cag_draft_take(g->draft, b->size, 1, err);
  return status;
}

static CagStatus read_buffers(CagGltf *g, const CagGltfBuffer *binary, CagError *err) {
  CagGltfArray list = {0};
  CagStatus status = read_array(g, "buffers", &list, err);
  if (!status) {
    g->buffers = cag_calloc(list.count + 1, sizeof *g->buffers);
    if (!g->buffers) status = cag_fail_memory(err);
  }
  for (size_t i = 0; !status && i < list.count; i++) {
    const cJSON *uri = cJSON_GetObjectItemCaseSensitive(list.items[i], "uri");
    size_t size;
    CagGltfBuffer *b = &g->buffers[g->buffer_count++];
    if (cJSON_IsString(uri)) status = open_buffer(g, uri->valuestring, b, err);
    else if (i == 0) *b = *binary;
    if (status) break;
    if (!cag_gltf_whole(list.items[i], "byteLength", 0, &size))
      status = cag_gltf_fail(g, err, CAG_ERR_mesh_file_syntax, "buffers[%zu] has no byteLength", i);
    else if (size > b->size)
      status = cag_gltf_fail(
          g, err, CAG_ERR_mesh_file_truncated,
          "buffers[%zu] states a length of %zu bytes, but has %zu; write or download it again", i,
          size, b->size);
    else b->size = size;
  }
  cag_free(list.items);
  return status;
}

// Only required extensions that do not affect the triangles are accepted.
static CagStatus check_extensions(CagGltf *g, CagError *err) {
  static const char *const harmless[] = {"KHR_materials_",      "KHR_texture_",
                                         "KHR_lights_punctual", "KHR_mesh_quantization",
                                         "EXT_texture_",        "KHR_xmp"};
  const cJSON *item;
  cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(g->json, "extensionsRequired")) {
    bool known = false;
    const char *name = cJSON_GetStringValue(item);
    for (size_t i = 0; i < sizeof harmless / sizeof *harmless; i++)
      known |= name && strncmp(name, harmless[i], strlen(harmless[i])) == 0;
    if (known) continue;
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_unsupported,
                         "it requires the extension %.80s; write it without this extension",
                         name ? name : "that is not text");
  }
  return CAG_OK;
}

CagStatus cag_gltf_open(CagGltf *g, CagMeshDraft *d, CagError *err) {
  *g = (CagGltf){.draft = d};
  const char *json;
  size_t size;
  CagGltfBuffer binary = {0};
  CagStatus status = find_chunks(g, &json, &size, &binary, err);
  if (!status) status = parse_json(g, json, size, err);
  if (status) return status;
  const cJSON *asset = cJSON_GetObjectItemCaseSensitive(g->json, "asset");
  const cJSON *version = cJSON_GetObjectItemCaseSensitive(asset, "version");
  if (!cJSON_IsString(version))
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_syntax,
                         "it is JSON, but not glTF: it has no asset");
  if (version->valuestring[0] != '2')
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_unsupported,
                         "it is glTF of version %.20s; write it as glTF 2.0", version->valuestring);
  status = check_extensions(g, err);
  if (!status) status = read_array(g, "nodes", &g->nodes, err);
  if (!status) status = read_array(g, "meshes", &g->meshes, err);
  if (!status) status = read_array(g, "accessors", &g->accessors, err);
  if (!status) status = read_array(g, "bufferViews", &g->views, err);
  return !status ? read_buffers(g, &binary, err) : status;
}

void cag_gltf_close(CagGltf *g) {
  for (size_t i = 0; i < g->buffer_count; i++)
    if (g->buffers[i].owned) cag_free(g->buffers[i].bytes);
  cag_free(g->buffers);
  cag_free(g->nodes.items);
  cag_free(g->meshes.items);
  cag_free(g->accessors.items);
  cag_free(g->views.items);
  cJSON_Delete(g->json);
}

// --- Accessors ---

static size_t component_size(int component) {
  switch (component) {
  case BYTE:
  case UBYTE: return 1;
  case SHORT:
  case USHORT: return 2;
  case UINT:
  case FLOAT: return 4;
  default: return 0;
  }
}

// Finds where `count` elements of `size` bytes start in a view. *stride is 0 if it is not given.
static CagStatus look_into_view(const CagGltf *g, const cJSON *said, size_t accessor, size_t count,
                                size_t size, const unsigned char **data, size_t *stride,
                                CagError *err) {
  size_t view, offset, at, length, buffer;
  if (!cag_gltf_whole(said, "bufferView", SIZE_MAX, &view) ||
      !cag_gltf_whole(said, "byteOffset", 0, &offset))
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_syntax, "accessors[%zu] has no whole numbers",
                         accessor);
  if (view >= g->views.count)
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_index,
                         "accessors[%zu] refers to a view that does not exist", accessor);
  const cJSON *v = g->views.items[view];
  if (!cag_gltf_whole(v, "buffer", SIZE_MAX, &buffer) || !cag_gltf_whole(v, "byteOffset", 0, &at) ||
      !cag_gltf_whole(v, "byteLength", 0, &length) || !cag_gltf_whole(v, "byteStride", 0, stride))
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_syntax, "bufferViews[%zu] has no whole numbers",
                         view);
  if (buffer >= g->buffer_count)
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_index,
                         "bufferViews[%zu] refers to a buffer that does not exist", view);
  const CagGltfBuffer *b = &g->buffers[buffer];
  if (at > b->size || length > b->size - at)
    return cag_gltf_fail(
        g, err, CAG_ERR_mesh_file_truncated,
        "bufferViews[%zu] extends to byte %zu of a buffer of %zu bytes; write the file again", view,
        at + length, b->size);
  if (*stride == 0) *stride = size;
  if (*stride < size) // overlapping elements
    return cag_gltf_fail(
        g, err, CAG_ERR_mesh_file_syntax,
        "bufferViews[%zu] has a stride of %zu bytes, less than its elements of %zu", view, *stride,
        size);
  bool fits =
      offset <= length &&
      (count == 0 || (length - offset >= size && (length - offset - size) / *stride >= count - 1));
  if (!fits)
    return cag_gltf_fail(
        g, err, CAG_ERR_mesh_file_truncated,
        "accessors[%zu] has %zu elements, more than fit its view of %zu bytes; write the file again",
        accessor, count, length);
  *data = (const unsigned char *)b->bytes + at + offset;
  return CAG_OK;
}

static CagStatus read_sparse(const CagGltf *g, const cJSON *sparse, size_t number,
                             CagGltfAccessor *a, CagError *err) {
  const cJSON *indices = cJSON_GetObjectItemCaseSensitive(sparse, "indices");
  const cJSON *values = cJSON_GetObjectItemCaseSensitive(sparse, "values");
  size_t component, size, stride;
  if (!cag_gltf_whole(sparse, "count", 0, &a->sparse_count) ||
      !cag_gltf_whole(indices, "componentType", 0, &component))
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_syntax,
                         "accessors[%zu].sparse has no whole numbers", number);
  if (component != UBYTE && component != USHORT && component != UINT)
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_syntax,
                         "accessors[%zu].sparse has indices of the type %zu", number, component);
  a->sparse_component = (int)component;
  size = component_size(a->sparse_component);
  CagStatus status =
      look_into_view(g, indices, number, a->sparse_count, size, &a->sparse_index, &stride, err);
  if (!status)
    status = look_into_view(g, values, number, a->sparse_count,
                            component_size(a->component) * (size_t)a->width, &a->sparse_data,
                            &stride, err);
  for (size_t i = 0; !status && i < a->sparse_count; i++)
    if (cag_gltf_index(a->sparse_index, a->sparse_component, i) >= a->count)
      status =
          cag_gltf_fail(g, err, CAG_ERR_mesh_file_index,
                        "accessors[%zu].sparse refers to an element that does not exist", number);
  return status;
}

CagStatus cag_gltf_accessor(const CagGltf *g, size_t number, int width, CagGltfAccessor *out,
                            CagError *err) {
  static const char *const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  *out = (CagGltfAccessor){.width = width};
  if (number >= g->accessors.count)
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_index,
                         "a primitive refers to an accessor that does not exist");
  const cJSON *a = g->accessors.items[number];
  const cJSON *type = cJSON_GetObjectItemCaseSensitive(a, "type");
  size_t component;
  if (!cag_gltf_whole(a, "count", 0, &out->count) ||
      !cag_gltf_whole(a, "componentType", 0, &component) || component > FLOAT ||
      component_size((int)component) == 0)
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_syntax,
                         "accessors[%zu] has no count, or an invalid component type", number);
  if (!cJSON_IsString(type) || strcmp(type->valuestring, types[width]) != 0)
    return cag_gltf_fail(g, err, CAG_ERR_mesh_file_syntax, "accessors[%zu] must be of the type %s",
                         number, types[width]);
  out->component = (int)component;
  out->normalized = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(a, "normalized"));
  size_t size = component_size(out->component) * (size_t)width;
  CagStatus status = CAG_OK;
  if (cJSON_GetObjectItemCaseSensitive(a, "bufferView"))
    status = look_into_view(g, a, number, out->count, size, &out->data, &out->stride, err);
  const cJSON *sparse = cJSON_GetObjectItemCaseSensitive(a, "sparse");
  if (!status && sparse) status = read_sparse(g, sparse, number, out, err);
  return status;
}

// Bytes may be unaligned.
static double read_component(const unsigned char *at, int component, bool normalized) {
  switch (component) {
  case BYTE: return normalized ? fmax((int8_t)at[0] / 127.0, -1) : (int8_t)at[0];
  case UBYTE: return normalized ? at[0] / 255.0 : at[0];
  case SHORT: {
    int16_t x = (int16_t)(uint16_t)(at[0] | at[1] << 8);
    return normalized ? fmax(x / 32767.0, -1) : x;
  }
  case USHORT: {
    uint16_t x = (uint16_t)(at[0] | at[1] << 8);
    return normalized ? x / 65535.0 : x;
  }
  case UINT: return cag_read_u32(at);
  default: {
    uint32_t bits = cag_read_u32(at);
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
  }
  }
}

double cag_gltf_number(const CagGltfAccessor *a, size_t i, int k) {
  if (!a->data) return 0;
  const unsigned char *at = a->data + i * a->stride + (size_t)k * component_size(a->component);
  return read_component(at, a->component, a->normalized);
}

double cag_gltf_sparse_number(const CagGltfAccessor *a, size_t i, int k) {
  size_t size = component_size(a->component);
  return read_component(a->sparse_data + (i * (size_t)a->width + (size_t)k) * size, a->component,
                        a->normalized);
}

uint32_t cag_gltf_index(const unsigned char *data, int component, size_t i) {
  const unsigned char *at = data + i * component_size(component);
  return component == UBYTE    ? at[0]
         : component == USHORT ? (uint32_t)(at[0] | at[1] << 8)
                               : cag_read_u32(at);
}
