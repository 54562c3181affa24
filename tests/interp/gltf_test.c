// glTF documents and their meshes: chunks, JSON, buffers, and accessors of every type against a
// reader of the test's own; and what is wrong with documents.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "interp/formats/gltf_document.h"
#include "interp/formats/mesh_read.h"

static CagError err;
static uint64_t seed;

static uint32_t random_below(uint32_t n) {
  seed = seed * 6364136223846793005u + 1442695040888963407u;
  return (uint32_t)(seed >> 33) % n;
}

typedef struct Text {
  char at[9000];
  size_t n;
} Text;

static void add(Text *t, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  t->n += (size_t)vsnprintf(t->at + t->n, sizeof t->at - t->n, format, arguments);
  va_end(arguments);
  assert_true(t->n < sizeof t->at);
}

static void add_u32(Text *t, uint32_t x) {
  for (int i = 0; i < 4; i++) t->at[t->n++] = (char)(x >> 8 * i & 255);
}

static void add_chunk(Text *t, const char *kind, const void *bytes, size_t n) {
  add_u32(t, (uint32_t)n);
  memcpy(t->at + t->n, kind, 4);
  memcpy(t->at + t->n + 4, bytes, n);
  t->n += 4 + n;
}

typedef struct Document {
  CagMeshFile file;
  CagMeshDraft draft;
  CagGltf g;
} Document;

static CagStatus open_bytes(Document *d, const char *bytes, size_t n) {
  d->file.name = "a.gltf";
  // A copy of exactly its length, so that a look beyond its end is seen.
  d->file.bytes = memcpy(malloc(n + 1), bytes, n);
  ((char *)d->file.bytes)[n] = 0;
  d->file.size = n;
  if (!d->file.max_memory) d->file.max_memory = 1 << 24;
  d->draft = (CagMeshDraft){.file = &d->file};
  return cag_gltf_open(&d->g, &d->draft, &err);
}

static void close_document(Document *d) {
  cag_gltf_close(&d->g);
  cag_draft_free(&d->draft);
  free((char *)d->file.bytes);
}

static void refused(const char *bytes, size_t n, const char *reason, const char *part) {
  Document d = {0};
  assert_int_not_equal(open_bytes(&d, bytes, n), CAG_OK);
  if (strcmp(cag_error_info(err.id)->reason, reason) != 0 || !strstr(err.message, part))
    fail_msg("%.200s: %s: %s", bytes, cag_error_info(err.id)->reason, err.message);
  assert_int_equal(strncmp(err.message, "a.gltf", 6), 0);
  close_document(&d);
}

#define ASSET "{\"asset\":{\"version\":\"2.0\"},"

// --- Accessors ---

typedef enum { BYTE = 5120, UBYTE, SHORT, USHORT, UINT = 5125, FLOAT } Component;
static const Component components[] = {BYTE, UBYTE, SHORT, USHORT, UINT, FLOAT};

static size_t size_of(Component c) {
  return c == BYTE || c == UBYTE ? 1 : c == SHORT || c == USHORT ? 2 : 4;
}

// A number of the file, and its value by the rules of glTF 2.0, 3.6.2.2.
static double put_number(unsigned char *at, Component c, bool normalized) {
  const uint32_t bits = random_below(4) == 0 ? 0x80808080u : random_below(1u << 31) * 2 + 1;
  const float f = ((float)random_below(2001) - 1000) / 64;
  switch (c) {
  case BYTE: {
    const int x = (int)(bits & 255) - (bits & 128 ? 256 : 0);
    at[0] = (unsigned char)bits;
    return !normalized ? x : x == -128 ? -1 : x / 127.0;
  }
  case UBYTE: at[0] = (unsigned char)bits; return (bits & 255) / (normalized ? 255.0 : 1);
  case SHORT: {
    const int x = (int)(bits & 65535) - (bits & 32768 ? 65536 : 0);
    at[0] = (unsigned char)bits, at[1] = (unsigned char)(bits >> 8);
    return !normalized ? x : x == -32768 ? -1 : x / 32767.0;
  }
  case USHORT:
    at[0] = (unsigned char)bits, at[1] = (unsigned char)(bits >> 8);
    return (bits & 65535) / (normalized ? 65535.0 : 1);
  case UINT:
    for (int i = 0; i < 4; i++) at[i] = (unsigned char)(bits >> 8 * i);
    return bits;
  default: {
    uint32_t u;
    memcpy(&u, &f, 4);
    for (int i = 0; i < 4; i++) at[i] = (unsigned char)(u >> 8 * i);
    return f;
  }
  }
}

// One view of elements at an offset with a stride, one of sparse indices and one of sparse values.
static void accessors_are_read_as_they_are_written(void **state) {
  (void)state;
  static const char *const types[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
  seed = 1;
  for (int round = 0; round < 400; round++) {
    unsigned char bytes[2000];
    double values[20][4], sparse_values[20][4];
    const Component c = components[round % 6], ic = components[(int[]){1, 3, 4}[round % 3]];
    const int width = 1 + round % 4;
    const bool normalized = round % 5 == 0, sparse = round % 2, zeros = round % 7 == 0;
    const size_t size = size_of(c) * (size_t)width, isize = size_of(ic);
    const size_t count = 1 + random_below(12), sparse_count = sparse ? random_below(5) : 0;
    const size_t stride = round % 3 ? 0 : size + random_below(9), step = stride ? stride : size;
    const size_t at = random_below(20), offset = random_below(12);
    const size_t length = offset + (count - 1) * step + size;
    const size_t iat = at + length + random_below(4), ilength = sparse_count * isize;
    const size_t sat = iat + ilength + random_below(4), slength = sparse_count * size;
    size_t indices[20];
    for (size_t i = 0; i < sizeof bytes; i++) bytes[i] = (unsigned char)random_below(256);
    for (size_t i = 0; i < count; i++)
      for (int k = 0; k < width; k++)
        values[i][k] =
            put_number(bytes + at + offset + i * step + (size_t)k * size_of(c), c, normalized);
    for (size_t i = 0; i < sparse_count; i++) {
      indices[i] = random_below((uint32_t)count);
      for (size_t b = 0; b < isize; b++)
        bytes[iat + i * isize + b] = b ? 0 : (unsigned char)indices[i];
      for (int k = 0; k < width; k++)
        sparse_values[i][k] =
            put_number(bytes + sat + ((size_t)width * i + (size_t)k) * size_of(c), c, normalized);
    }
    // First as it is, then each view a byte too short, then an element too many; then an index.
    for (int wrong = 0; wrong < 6; wrong++) {
      if ((wrong == 1 || wrong == 4) && zeros) continue;
      if ((wrong == 2 || wrong == 3 || wrong == 5) && sparse_count == 0) continue;
      if (wrong == 5) bytes[iat] = (unsigned char)count;
      Text json = {.n = 0}, file = {.n = 0};
      add(&json, ASSET "\"buffers\":[{\"byteLength\":%zu}],\"bufferViews\":[", sat + slength);
      add(&json, "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu", at, length - (wrong == 1));
      if (stride) add(&json, ",\"byteStride\":%zu", stride);
      add(&json, "},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu},", iat,
          ilength - (wrong == 2));
      add(&json, "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}],", sat,
          slength - (wrong == 3));
      add(&json, "\"accessors\":[{},{\"componentType\":%d,\"type\":\"%s\",\"count\":%zu", c,
          types[width], count + (wrong == 4));
      if (!zeros) add(&json, ",\"bufferView\":0,\"byteOffset\":%zu", offset);
      if (normalized) add(&json, ",\"normalized\":true");
      if (sparse)
        add(&json,
            ",\"sparse\":{\"count\":%zu,\"indices\":{\"bufferView\":1,\"componentType\":%d},"
            "\"values\":{\"bufferView\":2}}",
            sparse_count, ic);
      add(&json, "}]}");
      const size_t total = 12 + 8 + json.n + 8 + sat + slength;
      add(&file, "glTF");
      add_u32(&file, 2);
      add_u32(&file, (uint32_t)total);
      add_chunk(&file, "JSON", json.at, json.n);
      add_chunk(&file, "BIN\0", bytes, sat + slength);
      assert_int_equal(file.n, total);
      Document d = {0};
      CagGltfAccessor a;
      if (open_bytes(&d, file.at, file.n)) fail_msg("%s\n%s", err.message, json.at);
      const CagStatus status = cag_gltf_accessor(&d.g, 1, width, &a, &err);
      if (wrong == 5) {
        assert_string_equal(cag_error_info(err.id)->reason, "mesh-file-index");
      } else if (wrong) {
        assert_int_not_equal(status, CAG_OK);
        assert_string_equal(cag_error_info(err.id)->reason, "mesh-file-truncated");
        assert_non_null(strstr(err.message, "accessors[1] has"));
      } else {
        if (status) fail_msg("round %d: %s\n%s", round, err.message, json.at);
        assert_int_equal(a.count, count);
        assert_int_equal(a.sparse_count, sparse_count);
        for (size_t i = 0; i < count; i++)
          for (int k = 0; k < width; k++)
            assert_true(cag_gltf_number(&a, i, k) == (zeros ? 0 : values[i][k]));
        for (size_t i = 0; i < sparse_count; i++) {
          assert_int_equal(cag_gltf_index(a.sparse_index, a.sparse_component, i), indices[i]);
          for (int k = 0; k < width; k++)
            assert_true(cag_gltf_sparse_number(&a, i, k) == sparse_values[i][k]);
        }
      }
      close_document(&d);
    }
  }
}

static void indices_have_all_their_bytes(void **state) {
  (void)state;
  const unsigned char bytes[] = {0x12, 0x34, 0x56, 0x78, 0x9a, 0xbc, 0xde, 0xf0};
  assert_int_equal(cag_gltf_index(bytes, UBYTE, 6), 0xde);
  assert_int_equal(cag_gltf_index(bytes, USHORT, 1), 0x7856);
  assert_int_equal(cag_gltf_index(bytes, UINT, 1), 0xf0debc9a);
}

// A document of one accessor with one thing wrong.
static void accessors_are_checked(void **state) {
  (void)state;
#define BUFFER                                                                                     \
  "\"buffers\":[{\"byteLength\":20,\"uri\":\"data:;base64,AAAAAAAAAAAAAAAAAAAAAAAAAAA=\"}],"
#define VIEW(text) ASSET BUFFER "\"bufferViews\":[{" text "}],"
#define GOOD_VIEW VIEW("\"buffer\":0,\"byteLength\":20")
#define FLOATS "\"componentType\":5126,\"type\":\"SCALAR\""
#define SPARSE(text) ",\"sparse\":{" text "}"
  static const struct {
    const char *json, *accessor, *reason, *part;
  } cases[] = {
      {GOOD_VIEW, FLOATS ",\"count\":5,\"bufferView\":0", NULL, NULL},
      {GOOD_VIEW, FLOATS ",\"count\":0,\"bufferView\":0,\"byteOffset\":20", NULL, NULL},
      {GOOD_VIEW, FLOATS ",\"count\":0,\"bufferView\":0,\"byteOffset\":21", "mesh-file-truncated",
       ""},
      {GOOD_VIEW, FLOATS ",\"count\":6,\"bufferView\":0", "mesh-file-truncated", "6 elements"},
      {GOOD_VIEW, FLOATS ",\"count\":5,\"bufferView\":0,\"byteOffset\":1", "mesh-file-truncated",
       "20 bytes"},
      {GOOD_VIEW, FLOATS ",\"count\":1,\"bufferView\":1", "mesh-file-index", "refers to a view"},
      {GOOD_VIEW, FLOATS ",\"count\":1,\"bufferView\":-1", "mesh-file-syntax",
       "accessors[0] has no whole"},
      {GOOD_VIEW, FLOATS ",\"count\":1,\"bufferView\":0,\"byteOffset\":0.5", "mesh-file-syntax",
       "accessors[0] has no whole"},
      {GOOD_VIEW, FLOATS ",\"count\":1.5,\"bufferView\":0", "mesh-file-syntax", "no count"},
      {GOOD_VIEW, "\"componentType\":5124,\"type\":\"SCALAR\",\"count\":1", "mesh-file-syntax",
       "component type"},
      {GOOD_VIEW, "\"componentType\":5119,\"type\":\"SCALAR\",\"count\":1", "mesh-file-syntax",
       "component type"},
      {GOOD_VIEW, "\"componentType\":5127,\"type\":\"SCALAR\",\"count\":1", "mesh-file-syntax",
       "component type"},
      {GOOD_VIEW, "\"componentType\":4294972416,\"type\":\"SCALAR\",\"count\":1",
       "mesh-file-syntax", "component type"},
      {GOOD_VIEW, "\"componentType\":\"a\",\"type\":\"SCALAR\",\"count\":1", "mesh-file-syntax",
       "component type"},
      {GOOD_VIEW, "\"componentType\":5126,\"type\":\"VEC3\",\"count\":1", "mesh-file-syntax",
       "type SCALAR"},
      {GOOD_VIEW, "\"componentType\":5126,\"type\":3,\"count\":1", "mesh-file-syntax",
       "type SCALAR"},
      {GOOD_VIEW, "\"componentType\":5126,\"count\":1", "mesh-file-syntax", "type SCALAR"},
      {VIEW("\"buffer\":1,\"byteLength\":20"), FLOATS ",\"count\":1,\"bufferView\":0",
       "mesh-file-index", "refers to a buffer"},
      {VIEW("\"byteLength\":20"), FLOATS ",\"count\":1,\"bufferView\":0", "mesh-file-index",
       "refers to a buffer"},
      {VIEW("\"buffer\":\"\",\"byteLength\":20"), FLOATS ",\"count\":1,\"bufferView\":0",
       "mesh-file-syntax", "bufferViews[0]"},
      {VIEW("\"buffer\":0,\"byteLength\":-20"), FLOATS ",\"count\":1,\"bufferView\":0",
       "mesh-file-syntax", "bufferViews[0]"},
      {VIEW("\"buffer\":0,\"byteLength\":20,\"byteOffset\":0.1"),
       FLOATS ",\"count\":1,\"bufferView\":0", "mesh-file-syntax", "bufferViews[0]"},
      {VIEW("\"buffer\":0,\"byteLength\":20,\"byteStride\":[]"),
       FLOATS ",\"count\":1,\"bufferView\":0", "mesh-file-syntax", "bufferViews[0]"},
      {VIEW("\"buffer\":0,\"byteLength\":19,\"byteOffset\":2"),
       FLOATS ",\"count\":1,\"bufferView\":0", "mesh-file-truncated", "byte 21 of a buffer of 20"},
      {VIEW("\"buffer\":0,\"byteLength\":0,\"byteOffset\":21"),
       FLOATS ",\"count\":1,\"bufferView\":0", "mesh-file-truncated", "byte 21 of a buffer of 20"},
      {VIEW("\"buffer\":0,\"byteLength\":0,\"byteOffset\":20"),
       FLOATS ",\"count\":0,\"bufferView\":0", NULL, NULL},
      {VIEW("\"buffer\":0,\"byteLength\":18,\"byteOffset\":2"),
       FLOATS ",\"count\":4,\"bufferView\":0,\"byteOffset\":2", NULL, NULL},
      {VIEW("\"buffer\":0,\"byteLength\":20,\"byteStride\":3"),
       FLOATS ",\"count\":1,\"bufferView\":0", "mesh-file-syntax",
       "stride of 3 bytes, less than its elements of 4"},
      {VIEW("\"buffer\":0,\"byteLength\":20,\"byteStride\":4"),
       FLOATS ",\"count\":5,\"bufferView\":0", NULL, NULL},
      {VIEW("\"buffer\":0,\"byteLength\":20,\"byteStride\":8"),
       FLOATS ",\"count\":3,\"bufferView\":0", NULL, NULL},
      {VIEW("\"buffer\":0,\"byteLength\":20,\"byteStride\":9"),
       FLOATS ",\"count\":3,\"bufferView\":0", "mesh-file-truncated", "3 elements"},
      {GOOD_VIEW, FLOATS ",\"count\":5" SPARSE("\"count\":-1"), "mesh-file-syntax",
       "sparse has no whole"},
      {GOOD_VIEW, FLOATS ",\"count\":5" SPARSE("\"count\":1,\"indices\":{\"componentType\":0.5}"),
       "mesh-file-syntax", "sparse has no whole"},
      {GOOD_VIEW, FLOATS ",\"count\":5" SPARSE("\"count\":1,\"indices\":{\"componentType\":5122}"),
       "mesh-file-syntax", "indices of the type 5122"},
      {GOOD_VIEW, FLOATS ",\"count\":5" SPARSE("\"count\":1,\"indices\":{\"componentType\":5126}"),
       "mesh-file-syntax", "indices of the type 5126"},
      {GOOD_VIEW, FLOATS ",\"count\":5" SPARSE("\"count\":1,\"indices\":{\"componentType\":5121}"),
       "mesh-file-index", "refers to a view"},
      {GOOD_VIEW,
       FLOATS
       ",\"count\":5" SPARSE("\"count\":1,\"indices\":{\"componentType\":5121,\"bufferView\":0}"),
       "mesh-file-index", "refers to a view"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    Text t = {.n = 0};
    Document d = {0};
    CagGltfAccessor a;
    add(&t, "%s\"accessors\":[{%s}]}", cases[i].json, cases[i].accessor);
    if (open_bytes(&d, t.at, t.n)) fail_msg("%zu: %s", i, err.message);
    const CagStatus status = cag_gltf_accessor(&d.g, 0, 1, &a, &err);
    if (cases[i].reason ? !status || strcmp(cag_error_info(err.id)->reason, cases[i].reason) != 0 ||
                              !strstr(err.message, cases[i].part)
                        : status)
      fail_msg("%zu: %s: %s", i, cag_error_info(err.id)->reason, err.message);
    assert_int_not_equal(cag_gltf_accessor(&d.g, 1, 1, &a, &err), CAG_OK);
    assert_string_equal(cag_error_info(err.id)->reason, "mesh-file-index");
    close_document(&d);
  }
}

static void whole_numbers_are_exact(void **state) {
  (void)state;
  cJSON *o = cJSON_Parse("{\"a\":0,\"b\":7,\"c\":9007199254740992,\"d\":9007199254740994,\"e\":0.5,"
                         "\"f\":-1,\"g\":\"7\",\"h\":1e300}");
  size_t x;
  assert_true(cag_gltf_whole(o, "a", 5, &x) && x == 0);
  assert_true(cag_gltf_whole(o, "b", 5, &x) && x == 7);
  assert_true(cag_gltf_whole(o, "c", 5, &x) && x == 9007199254740992u);
  assert_true(cag_gltf_whole(o, "none", 5, &x) && x == 5);
  for (const char *key = "defgh"; *key; key++)
    assert_false(cag_gltf_whole(o, (char[]){*key, 0}, 5, &x));
  cJSON_Delete(o);
}

// --- Buffers ---

static void base64_is_read(void **state) {
  (void)state;
  static const char alphabets[2][65] = {
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/",
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"};
  seed = 2;
  for (size_t round = 0; round < 200; round++) {
    unsigned char bytes[70] = {0};
    const size_t n = round % 67, digits = (8 * n + 5) / 6;
    Text t = {.n = 0};
    Document d = {0};
    for (size_t i = 0; i < n; i++) bytes[i] = (unsigned char)random_below(256);
    add(&t, ASSET "\"buffers\":[{\"byteLength\":%zu,\"uri\":\"DATA:a/b;Base64,", n);
    for (size_t i = 0; i < digits; i++) {
      unsigned value = 0; // six bits from bit 6 i on
      for (size_t b = 6 * i; b < 6 * i + 6; b++)
        value = value << 1 | (bytes[b / 8] >> (7 - b % 8) & 1);
      add(&t, "%c", alphabets[round % 2][value]);
    }
    for (size_t i = digits; round % 3 && i % 4; i++) add(&t, "=");
    add(&t, "\"}]}");
    assert_int_equal(open_bytes(&d, t.at, t.n), CAG_OK);
    assert_int_equal(d.g.buffer_count, 1);
    assert_int_equal(d.g.buffers[0].size, n);
    assert_memory_equal(d.g.buffers[0].bytes, bytes, n);
    close_document(&d);
  }
  for (int c = 33; c < 127; c++) {
    Text t = {.n = 0};
    if (strchr(alphabets[0], c) || strchr(alphabets[1], c) || c == '=' || c == '"' || c == '\\')
      continue;
    add(&t, ASSET "\"buffers\":[{\"byteLength\":1,\"uri\":\"data:;base64,AA%c\"}]}", c);
    char part[40];
    snprintf(part, sizeof part, "the character 0x%02x", c);
    refused(t.at, t.n, "mesh-file-syntax", part);
  }
}

static char opened[200];

static CagStatus open_file(void *context, const char *path, char **bytes, size_t *n, CagError *e) {
  (void)context, (void)e;
  snprintf(opened, sizeof opened, "%s", path);
  *bytes = calloc(1, 10);
  *n = 10;
  return CAG_OK;
}

static void buffers_lie_beside(void **state) {
  (void)state;
  static const struct {
    const char *uri, *path;
  } cases[] = {
      {"a.bin", "a.bin"},       {"%41%4a%4A%7e", "AJJ~"},         {"a%20b", "a b"},
      {"%00a", "%00a"},         {"%g1%1g%", "%g1%1g%"},           {"%2", "%2"},
      {"%01b%fF", "\001b\xff"}, {"%@1%1@%`1%G0", "%@1%1@%`1%G0"}, {"%09%:0%/0", "\t%:0%/0"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    Text t = {.n = 0};
    Document d = {.file.open = open_file};
    add(&t, ASSET "\"buffers\":[{\"byteLength\":7,\"uri\":\"%s\"}]}", cases[i].uri);
    assert_int_equal(open_bytes(&d, t.at, t.n), CAG_OK);
    assert_string_equal(opened, cases[i].path);
    assert_int_equal(d.g.buffers[0].size, 7); // as said
    close_document(&d);
  }
#define BUFFERS(text) ASSET "\"buffers\":[" text "]}"
  static const struct {
    const char *json, *reason, *part;
  } bad[] = {
      {BUFFERS("{\"byteLength\":1,\"uri\":\"a.bin\"}"), "mesh-file-unsupported", "is at a.bin"},
      {BUFFERS("{\"byteLength\":1,\"uri\":\"data:base64,AAAA\"}"), "mesh-file-unsupported",
       "is not base64"},
      {BUFFERS("{\"byteLength\":1,\"uri\":\"data:x;base64\"}"), "mesh-file-unsupported",
       "is not base64"},
      {BUFFERS("{\"byteLength\":1,\"uri\":\"data:x;base65,AAAA\"}"), "mesh-file-unsupported",
       "is not base64"},
      {BUFFERS("{\"byteLength\":4,\"uri\":\"data:;base64,AAAA\"}"), "mesh-file-truncated",
       "buffers[0] states a length of 4 bytes, but has 3"},
      {BUFFERS("{\"byteLength\":1}"), "mesh-file-truncated",
       "buffers[0] states a length of 1 bytes, but has 0"},
      {BUFFERS("{\"byteLength\":0},{\"byteLength\":\"\"}"), "mesh-file-syntax",
       "buffers[1] has no byteLength"},
      {BUFFERS("3"), "mesh-file-syntax", "buffers[0] is not an object"},
      {BUFFERS("{},[]"), "mesh-file-syntax", "buffers[1] is not an object"},
      {ASSET "\"nodes\":3}", "mesh-file-syntax", "`nodes` is not an array"},
      {ASSET "\"meshes\":{}}", "mesh-file-syntax", "`meshes` is not an array"},
      {ASSET "\"accessors\":\"\"}", "mesh-file-syntax", "`accessors` is not an array"},
      {ASSET "\"bufferViews\":true}", "mesh-file-syntax", "`bufferViews` is not an array"},
      {ASSET "\"buffers\":1}", "mesh-file-syntax", "`buffers` is not an array"},
      {"{\"asset\":{\"version\":2}}", "mesh-file-syntax", "no asset"},
      {"{\"asset\":{\"version\":\"12\"}}", "mesh-file-unsupported", "version 12"},
      {"[]", "mesh-file-syntax", "JSON of the file"},
  };
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
    refused(bad[i].json, strlen(bad[i].json), bad[i].reason, bad[i].part);
}

// --- JSON and chunks ---

static const char whole[] = ASSET "\n\"a\":[1,{\"b\\\"[\\\\\":\"]}\"}],\n\"nodes\":[{},{}]}";

static void json_that_ends_early_is_told(void **state) {
  (void)state;
  Document d = {0};
  assert_int_equal(open_bytes(&d, whole, strlen(whole)), CAG_OK);
  assert_int_equal(d.g.nodes.count, 2);
  // What was taken: 96 bytes for each of 1 value, 7 brackets and 4 commas that stand outside of
  // texts, the text, and arrays with one element more than they have: nodes 3.
  assert_int_equal(d.draft.taken, 96 * (1 + 7 + 4) + strlen(whole) + 3 * sizeof(void *));
  close_document(&d);
  for (size_t n = 1; n < strlen(whole); n++)
    refused(whole, n, "mesh-file-truncated", "it is incomplete");
  // Broken, and not by its end: brackets in texts do not count.
  static const struct {
    const char *json, *place;
  } broken[] = {{"{\"a\":\"[[\",,}", "line 1"},
                {"{\n\n\"a\":x}", "line 3"},
                {"{\"a\\\\\":\n}", "line 2"},
                {"{\"{\\\"{\"\n:}", "line 2"}};
  for (size_t i = 0; i < sizeof broken / sizeof *broken; i++)
    refused(broken[i].json, strlen(broken[i].json), "mesh-file-syntax", broken[i].place);
  // The memory is counted before it is taken.
  const size_t needed = 96 * (1 + 7 + 4) + strlen(whole) + 3 * sizeof(void *);
  for (size_t less = 0; less < 2; less++) {
    Document bounded = {.file.max_memory = needed - less};
    assert_int_equal(open_bytes(&bounded, whole, strlen(whole)), less ? CAG_E_MEMORY : CAG_OK);
    close_document(&bounded);
  }
}

static Text glb_of(uint32_t version, uint32_t more) {
  Text t = {.n = 0};
  add(&t, "glTF");
  add_u32(&t, version);
  add_u32(&t, more);
  return t;
}

static void set_size(Text *t, size_t size) {
  for (int i = 0; i < 4; i++) t->at[8 + i] = (char)(size >> 8 * i & 255);
}

static void chunks_are_found(void **state) {
  (void)state;
  static const char json[] = ASSET "\"buffers\":[{\"byteLength\":3}]}";
  static const char other[] = "{}";
  for (int kind = 0; kind < 4; kind++) {
    Text t = glb_of(2, 0);
    Document d = {0};
    if (kind == 1) add_chunk(&t, "BIN\0", "abc", 3);
    if (kind == 2) add_chunk(&t, "ODD ", "xyzw", 4);
    add_chunk(&t, "JSON", json, strlen(json));
    if (kind == 3) add_chunk(&t, "JSON", other, strlen(other)); // the first counts
    if (kind != 1) add_chunk(&t, "BIN\0", "abcd", 4);
    add_chunk(&t, "BIN\0", "efg", 3);
    add(&t, "1234567"); // no chunk any more
    set_size(&t, t.n - (size_t)kind);
    assert_int_equal(open_bytes(&d, t.at, t.n), CAG_OK);
    assert_int_equal(d.g.buffers[0].size, 3);
    assert_memory_equal(d.g.buffers[0].bytes, "abc", 3);
    close_document(&d);
  }
  Text t = glb_of(2, 12);
  refused(t.at, 12, "mesh-file-syntax", "no JSON chunk");
  refused(t.at, 11, "mesh-file-truncated", "11 bytes of the 12");
  refused(t.at, 4, "mesh-file-truncated", "4 bytes of the 12");
  t = glb_of(2, 13);
  refused(t.at, 12, "mesh-file-truncated", "12 bytes of the 13");
  t = glb_of(1, 12);
  refused(t.at, 12, "mesh-file-unsupported", "version 1;");
  t = glb_of(3, 12);
  refused(t.at, 12, "mesh-file-unsupported", "version 3;");
  t = glb_of(2, 0);
  add_chunk(&t, "JSON", json, strlen(json));
  add_u32(&t, 5);
  add(&t, "ODD four");
  refused(t.at, t.n, "mesh-file-truncated", "a chunk has 5 bytes, but only 4 are left");
  // The second buffer has no chunk.
  static const char two[] = ASSET "\"buffers\":[{\"byteLength\":1},{\"byteLength\":1}]}";
  t = glb_of(2, 0);
  add_chunk(&t, "JSON", two, strlen(two));
  add_chunk(&t, "BIN\0", "abcd", 4);
  refused(t.at, t.n, "mesh-file-truncated", "buffers[1] states");
}

// --- Meshes ---

static void add_float(Text *t, double x) {
  const float f = (float)x;
  uint32_t bits;
  memcpy(&bits, &f, 4);
  add_u32(t, bits);
}

// An accessor of all that follows in the data up to now, with a view of its own.
static void add_accessor(Text *views, Text *accessors, size_t from, size_t to, int component,
                         const char *type, size_t count) {
  add(views, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", views->n ? "," : "", from,
      to - from);
  size_t view = 0;
  for (size_t i = 0; i < views->n; i++) view += views->at[i] == '{';
  add(accessors, "%s{\"bufferView\":%zu,\"componentType\":%d,\"type\":\"%s\",\"count\":%zu}",
      accessors->n ? "," : "", view - 1, component, type, count);
}

typedef struct Corner {
  CagVec3 p;
  double uv[2];
} Corner;

// Primitives of all modes in several meshes: the triangles are those of glTF 2.0, 3.7.2.1.
static void primitives_are_read_in_their_modes(void **state) {
  (void)state;
  seed = 3;
  for (int round = 0; round < 200; round++) {
    Text views = {.n = 0}, accessors = {.n = 0}, meshes = {.n = 0}, data = {.n = 0};
    Corner expected[200];
    size_t corner_count = 0, accessor = 0;
    bool any_uv = false;
    const int primitives = 1 + round % 3;
    for (int p = 0; p < primitives; p++) {
      const size_t n = 1 + random_below(7), mode = random_below(7), from = data.n;
      const bool indexed = random_below(2), uv = random_below(2);
      Corner v[8];
      size_t k[12], corners = n;
      for (size_t i = 0; i < n; i++) {
        const double x = 10 * p + (double)i, y = random_below(100), z = random_below(100);
        v[i].p = cag_vec3(1000 * x, -1000 * z, 1000 * y);
        add_float(&data, x), add_float(&data, y), add_float(&data, z);
        k[i] = i;
      }
      add_accessor(&views, &accessors, from, data.n, FLOAT, "VEC3", n);
      add(&meshes, "%s{\"primitives\":[{\"mode\":%zu,\"attributes\":{\"POSITION\":%zu",
          p ? "," : "", mode, accessor++);
      const size_t uv_from = data.n;
      for (size_t i = 0; i < n; i++) {
        for (int j = 0; j < 2; j++) {
          v[i].uv[j] = uv ? random_below(65536) / 256.0 : 0;
          if (uv) add_float(&data, v[i].uv[j]);
        }
      }
      if (uv) {
        add_accessor(&views, &accessors, uv_from, data.n, FLOAT, "VEC2", n);
        add(&meshes, ",\"TEXCOORD_0\":%zu", accessor++);
      }
      add(&meshes, "}");
      if (indexed) {
        const size_t start = data.n;
        corners = random_below(12);
        for (size_t i = 0; i < corners; i++) {
          k[i] = random_below((uint32_t)n);
          data.at[data.n++] = (char)k[i];
        }
        add_accessor(&views, &accessors, start, data.n, UBYTE, "SCALAR", corners);
        add(&meshes, ",\"indices\":%zu", accessor++);
        while (data.n % 4) data.at[data.n++] = 0;
      }
      add(&meshes, "}]}");
      // Sequences of three, a strip whose odd triangles are turned, a fan.
      size_t triangles = 0;
      if (mode == 4) triangles = corners / 3;
      else if (mode > 4 && corners > 2) triangles = corners - 2;
      any_uv |= uv && triangles > 0;
      for (size_t t = 0; t < triangles; t++) {
        const size_t strip[3] = {t, t + 1 + t % 2, t + 2 - t % 2}, fan[3] = {0, t + 1, t + 2},
                     list[3] = {3 * t, 3 * t + 1, 3 * t + 2};
        const size_t *at = mode == 4 ? list : mode == 5 ? strip : fan;
        // Those that have a point twice are left out; all are at places of their own.
        const size_t a = k[at[0]], b = k[at[1]], c = k[at[2]];
        if (a == b || b == c || c == a) continue;
        for (int j = 0; j < 3; j++) expected[corner_count++] = v[k[at[j]]];
      }
    }
    Text json = {.n = 0}, file = glb_of(2, 0);
    add(&json, ASSET "\"buffers\":[{\"byteLength\":%zu}],\"bufferViews\":[%.*s],", data.n,
        (int)views.n, views.at);
    add(&json, "\"accessors\":[%.*s],\"meshes\":[%.*s]}", (int)accessors.n, accessors.at,
        (int)meshes.n, meshes.at);
    add_chunk(&file, "JSON", json.at, json.n);
    add_chunk(&file, "BIN\0", data.at, data.n);
    set_size(&file, file.n);
    const CagMeshFile f = {
        .name = "a.glb", .bytes = file.at, .size = file.n, .max_memory = 1 << 24};
    CagMesh *m = NULL;
    const CagStatus status = cag_mesh_read(&f, &m, &err);
    if (corner_count == 0) {
      assert_int_not_equal(status, CAG_OK);
      assert_string_equal(cag_error_info(err.id)->reason, "mesh-file-empty");
      continue;
    }
    if (status) fail_msg("round %d: %s\n%s", round, err.message, json.at);
    assert_int_equal(3 * m->triangle_count, corner_count);
    assert_int_equal(m->uv != NULL, any_uv);
    // Meshes are read from the last to the first.
    for (size_t t = 0; t < m->triangle_count; t++) {
      bool found = false;
      for (size_t e = 0; e < corner_count && !found; e++) { // from any of its corners
        found = true;
        for (size_t j = 0; j < 3; j++) {
          const uint32_t at = m->triangles[3 * t + j];
          const Corner *c = &expected[e / 3 * 3 + (e + j) % 3];
          found &= cag_norm(cag_sub(m->positions[at], c->p)) == 0 &&
                   (!m->uv || (m->uv[2 * at] == c->uv[0] && m->uv[2 * at + 1] == c->uv[1]));
        }
      }
      if (!found) fail_msg("round %d: triangle %zu\n%s", round, t, json.at);
    }
    cag_mesh_release(m);
  }
}

// A triangle: 36 bytes of positions, and three indices.
static const char triangle[] =
    "\"buffers\":[{\"byteLength\":39,\"uri\":\"data:;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAAAAAIC/AAEC\"}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},"
    "{\"buffer\":0,\"byteOffset\":36,\"byteLength\":3}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
    "{\"bufferView\":1,\"componentType\":5121,\"count\":3,\"type\":\"SCALAR\"},"
    "{\"bufferView\":1,\"componentType\":5120,\"count\":3,\"type\":\"SCALAR\"},"
    "{\"componentType\":5121,\"count\":3,\"type\":\"SCALAR\"},"
    "{\"bufferView\":0,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"},"
    "{\"bufferView\":0,\"componentType\":5126,\"count\":2,\"type\":\"VEC2\"}],";

static CagStatus read_triangles(const char *rest, CagMesh **m) {
  Text t = {.n = 0};
  add(&t, ASSET "%s%s}", triangle, rest);
  const CagMeshFile f = {.name = "a.gltf", .bytes = t.at, .size = t.n, .max_memory = 1 << 24};
  *m = NULL;
  return cag_mesh_read(&f, m, &err);
}

static void scenes_and_primitives_are_checked(void **state) {
  (void)state;
#define PRIMITIVE(text) "\"meshes\":[{\"primitives\":[{" text "}]}]"
#define MESH PRIMITIVE("\"attributes\":{\"POSITION\":0}")
#define TWO "\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[0,0,5]}]," MESH
  static const struct {
    const char *rest;
    size_t triangles;
    const char *reason, *part;
  } cases[] = {
      {MESH, 1, NULL, NULL},
      {MESH ",\"nodes\":[]", 1, NULL, NULL},
      {TWO, 2, NULL, NULL},
      {TWO ",\"scenes\":[{\"nodes\":[1]}]", 1, NULL, NULL},
      {TWO ",\"scenes\":[{\"nodes\":[1,0]}]", 2, NULL, NULL},
      {TWO ",\"scene\":1,\"scenes\":[{\"nodes\":[0,1]},{\"nodes\":[1]}]", 1, NULL, NULL},
      {TWO ",\"scene\":2,\"scenes\":[{},{}]", 0, "mesh-file-index",
       "the default scene does not exist"},
      {TWO ",\"scene\":0,\"scenes\":[]", 0, "mesh-file-index", "the default scene does not exist"},
      {TWO ",\"scene\":-1,\"scenes\":[{}]", 0, "mesh-file-index",
       "the default scene does not exist"},
      {TWO ",\"scenes\":[{}]", 0, "mesh-file-empty", "no triangle"},
      {TWO ",\"scenes\":[{\"nodes\":[2]}]", 0, "mesh-file-index",
       "refers to node 2, but there are 2 nodes"},
      {TWO ",\"scenes\":[{\"nodes\":[0.5]}]", 0, "mesh-file-index", "refers to node 0.5"},
      {TWO ",\"scenes\":[{\"nodes\":[-1]}]", 0, "mesh-file-index", "refers to node -1"},
      {TWO ",\"scenes\":[{\"nodes\":[\"a\"]}]", 0, "mesh-file-index", "refers to node -1"},
      {TWO ",\"scenes\":[{\"nodes\":[0,0]}]", 0, "mesh-file-syntax", "nodes[0] occurs twice"},
      {"\"nodes\":[{\"children\":[2]},{\"children\":[0]},{\"mesh\":0}]," MESH, 1, NULL, NULL},
      {"\"nodes\":[{\"children\":[5]},{\"mesh\":0}]," MESH, 0, "mesh-file-index",
       "refers to node 5"},
      {"\"nodes\":[{\"mesh\":1}]," MESH, 0, "mesh-file-index", "nodes[0] refers to a mesh"},
      {"\"nodes\":[{\"mesh\":0.5}]," MESH, 0, "mesh-file-index", "nodes[0] refers to a mesh"},
      {"\"nodes\":[{\"rotation\":[0,0,0,0]}]," MESH, 0, "mesh-file-syntax",
       "nodes[0] has an invalid matrix"},
      {"\"nodes\":[{\"scale\":[1,1]}]," MESH, 0, "mesh-file-syntax",
       "nodes[0] has an invalid matrix"},
      {"\"nodes\":[{\"scale\":[1,1,\"\"]}]," MESH, 0, "mesh-file-syntax",
       "nodes[0] has an invalid matrix"},
      {"\"nodes\":[{\"translation\":3}]," MESH, 0, "mesh-file-syntax",
       "nodes[0] has an invalid matrix"},
      {PRIMITIVE("\"attributes\":{\"POSITION\":0},\"indices\":1"), 1, NULL, NULL},
      {PRIMITIVE("\"attributes\":{\"POSITION\":0},\"indices\":1,\"mode\":6"), 1, NULL, NULL},
      {PRIMITIVE("\"attributes\":{\"POSITION\":0},\"mode\":7"), 0, "mesh-file-syntax",
       "an invalid mode"},
      {PRIMITIVE("\"attributes\":{\"POSITION\":0},\"indices\":-1"), 0, "mesh-file-syntax",
       "an invalid mode"},
      {PRIMITIVE("\"attributes\":{\"POSITION\":0},\"indices\":2"), 0, "mesh-file-syntax",
       "accessors[2] has no indices"},
      {PRIMITIVE("\"attributes\":{\"POSITION\":0},\"indices\":3"), 0, "mesh-file-unsupported",
       "accessors[3] has sparse"},
      {PRIMITIVE("\"attributes\":{\"POSITION\":0},\"indices\":0"), 0, "mesh-file-syntax",
       "accessors[0] must be of the type SCALAR"},
      {PRIMITIVE("\"attributes\":{\"POSITION\":4},\"indices\":1"), 0, "mesh-file-index",
       "triangle 0 of a mesh refers to vertex 2, but there are 2 vertices"},
      {PRIMITIVE("\"attributes\":{\"POSITION\":4}"), 0, "mesh-file-empty", ""},
      {PRIMITIVE("\"attributes\":{}"), 0, "mesh-file-empty", ""},
      {PRIMITIVE("\"attributes\":{\"POSITION\":\"\"}"), 0, "mesh-file-syntax", "an attribute"},
      {PRIMITIVE("\"attributes\":{\"POSITION\":0,\"NORMAL\":0.5}"), 0, "mesh-file-syntax",
       "an attribute"},
      {PRIMITIVE("\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":-1}"), 0, "mesh-file-syntax",
       "an attribute"},
      {PRIMITIVE("\"attributes\":{\"POSITION\":0,\"NORMAL\":4}"), 0, "mesh-file-syntax",
       "accessors[0] has 3 points"},
      {PRIMITIVE("\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":5}"), 0, "mesh-file-syntax",
       "accessors[0] has 3 points"},
      {PRIMITIVE("\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":4}"), 0, "mesh-file-syntax",
       "type VEC2"},
      {PRIMITIVE("\"attributes\":{\"POSITION\":0,\"NORMAL\":5}"), 0, "mesh-file-syntax",
       "type VEC3"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    CagMesh *m;
    const CagStatus status = read_triangles(cases[i].rest, &m);
    if (!cases[i].reason) {
      if (status) fail_msg("%zu: %s", i, err.message);
      assert_int_equal(m->triangle_count, cases[i].triangles);
      cag_mesh_release(m);
    } else if (!status || strcmp(cag_error_info(err.id)->reason, cases[i].reason) != 0 ||
               !strstr(err.message, cases[i].part)) {
      fail_msg("%zu: %s: %s", i, cag_error_info(err.id)->reason, err.message);
    }
  }
}

// More nodes below one another, and beside one another, than the walk has room for at first.
static void many_nodes_are_walked(void **state) {
  (void)state;
  for (int deep = 0; deep < 2; deep++) {
    const int n = 150;
    Text t = {.n = 0};
    CagMesh *m;
    add(&t, "\"nodes\":[");
    for (int i = 0; i < n; i++) {
      add(&t, "%s{\"mesh\":0,\"translation\":[0,%d,0]", i ? "," : "", deep ? 1 : i + 1);
      if (deep && i + 1 < n) add(&t, ",\"children\":[%d]", i + 1);
      add(&t, "}");
    }
    add(&t, "]," MESH);
    if (read_triangles(t.at, &m)) fail_msg("%s", err.message);
    assert_int_equal(m->triangle_count, n);
    double sum = 0;
    for (size_t v = 0; v < m->vertex_count; v++) sum += m->positions[v].z;
    assert_int_equal(m->vertex_count, 3 * n);
    assert_true(sum == 1000.0 * 3 * n * (n + 1) / 2);
    cag_mesh_release(m);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(accessors_are_read_as_they_are_written),
      cmocka_unit_test(indices_have_all_their_bytes),
      cmocka_unit_test(accessors_are_checked),
      cmocka_unit_test(whole_numbers_are_exact),
      cmocka_unit_test(base64_is_read),
      cmocka_unit_test(buffers_lie_beside),
      cmocka_unit_test(json_that_ends_early_is_told),
      cmocka_unit_test(chunks_are_found),
      cmocka_unit_test(primitives_are_read_in_their_modes),
      cmocka_unit_test(scenes_and_primitives_are_checked),
      cmocka_unit_test(many_nodes_are_walked),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
