// Reading EXR files.
//
// The file is first read into memory, so that its length cannot change while it is decoded, and
// standard input works like a file. The library's strict header checks are on, and its
// reconstruction of missing chunk tables is off: a damaged picture is an error.

#include <errno.h>
#include <fcntl.h>
#include <openexr.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/stop.h"
#include "interp/render/exr.h"
#include "interp/render/exr_complaint.h"

// The largest file that is read: an uncompressed float picture of CAG_IMAGE_SAMPLES_MAX samples and
// its header.
#define FILE_SIZE_MAX (((size_t)1 << 32) + ((size_t)1 << 24))
// The first block for inputs of unknown length (pipes).
#define PIPE_BLOCK ((size_t)1 << 20)
// The first four bytes of every EXR.
static const unsigned char MAGIC[4] = {0x76, 0x2f, 0x31, 0x01};

// The bytes, and the first error message of the library.
typedef struct {
  const unsigned char *bytes;
  size_t size;
  const char *shown;
  CagExrComplaint complaint;
} Source;

static bool fail(CagError *err, const Source *source, const char *what) {
  return cag_fail_io(err, CAG_E_FILE, NULL, "cannot read '%s' as EXR: %s", source->shown, what);
}

static bool fail_code(CagError *err, const Source *source, exr_result_t code) {
  if (cag_stopped()) return cag_fail_io(err, CAG_E_CALLBACK, NULL, "reading was stopped");
  if (code == EXR_ERR_FEATURE_NOT_IMPLEMENTED)
    return cag_fail_io(
        err, CAG_E_FILE, "store it with ZIP, PIZ, RLE, or no compression",
        "cannot read '%s' as EXR: OpenEXRCore does not decode its compression correctly for channels like these",
        source->shown);
  return fail(err, source, cag_exr_complaint_text(&source->complaint, code));
}

static int64_t source_read(exr_const_context_t ctxt, void *user, void *buffer, uint64_t n,
                           uint64_t offset, exr_stream_error_func_ptr_t error_cb) {
  const Source *source = user;
  (void)ctxt, (void)error_cb;
  // Like pread, returns the available bytes: the library may read beyond the end of a short file,
  // and checks whether it got enough.
  if (offset >= source->size) return 0;
  if (n > source->size - offset) n = source->size - offset;
  memcpy(buffer, source->bytes + offset, (size_t)n);
  return (int64_t)n;
}

static int64_t source_size(exr_const_context_t ctxt, void *user) {
  (void)ctxt;
  return (int64_t)((const Source *)user)->size;
}

// A part of the file that is decoded into planes first_channel ... of the image.
typedef struct {
  exr_context_t file;
  int part;
  const CagImage *image;
  size_t first_channel;
  exr_attr_box2i_t data, display;
  bool begun;
  exr_decode_pipeline_t decoder;
  int64_t x0, y0;                                      // upper left pixel of the current chunk
  exr_result_t (*decompress)(exr_decode_pipeline_t *); // the function that the library chose
} PartReader;

// An IEEE 754 binary16 number.
static float half_to_float(uint16_t h) {
  const uint32_t sign = (uint32_t)(h & 0x8000) << 16;
  uint32_t exponent = h >> 10 & 31, fraction = h & 1023, bits;
  if (exponent == 31) {
    bits = sign | 0x7f800000 | fraction << 13;
  } else if (exponent) {
    bits = sign | (exponent + 127 - 15) << 23 | fraction << 13;
  } else {
    const float tiny = (float)fraction * 0x1p-24f;
    return sign ? -tiny : tiny;
  }
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

// Converts a sample from the file, little-endian.
static float sample(const uint8_t *at, uint16_t type) {
  if (type == EXR_PIXEL_HALF) return half_to_float((uint16_t)(at[0] | at[1] << 8));
  const uint32_t bits =
      (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
  if (type == EXR_PIXEL_UINT) return (float)bits;
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

static int64_t clamp(int64_t i, int64_t least, int64_t most) {
  return i < least ? least : i > most ? most : i;
}

// Copies one stored row of `count` samples, the first of which belongs to the file's pixel (x, y),
// to the part of the plane in the display window. With coarser sampling, a sample fills xs by ys
// pixels.
static void put_row(const PartReader *r, const exr_coding_channel_info_t *c, float *plane,
                    const uint8_t *from, int64_t x, int64_t y, int64_t count) {
  const int64_t width = (int64_t)r->image->width, height = (int64_t)r->image->height;
  const int64_t xs = c->x_samples, ys = c->y_samples, size = c->bytes_per_element;
  const int64_t left = x - r->display.min.x, top = y - r->display.min.y;
  const int64_t column_end = clamp(left + count * xs, 0, width);
  const int64_t row_end = clamp(top + ys, 0, height);
  for (int64_t row = top < 0 ? 0 : top; row < row_end; row++) {
    float *to = plane + row * width;
    for (int64_t column = left < 0 ? 0 : left; column < column_end; column++)
      to[column] =
          sample(from + (xs == 1 ? column - left : (column - left) / xs) * size, c->data_type);
  }
}

// The last step of the decoder. It replaces the library's own, which handles coarser samplings
// incorrectly in version 3.1. The data of a chunk are its rows from top to bottom; a row contains
// only the channels that have samples in it. The library checks that windows are aligned with
// samples.
static exr_result_t unpack(exr_decode_pipeline_t *d) {
  const PartReader *r = d->decoding_user_data;
  const uint8_t *at = d->unpacked_buffer;
  uint64_t rest = d->chunk.unpacked_size;
  if (!at) return EXR_ERR_CORRUPT_CHUNK;
  for (int64_t y = r->y0; y < r->y0 + d->chunk.height; y++) {
    for (int16_t i = 0; i < d->channel_count; i++) {
      const exr_coding_channel_info_t *c = &d->channels[i];
      const int64_t xs = c->x_samples;
      if (y % c->y_samples != 0) continue;
      const int64_t count = d->chunk.width / xs;
      const uint64_t bytes = (uint64_t)count * (uint64_t)c->bytes_per_element;
      if (bytes > rest) return EXR_ERR_CORRUPT_CHUNK;
      put_row(r, c, cag_image_plane(r->image, r->first_channel + (size_t)i), at, r->x0, y, count);
      at += bytes;
      rest -= bytes;
    }
  }
  return EXR_ERR_SUCCESS;
}

// A chunk that compression would not make smaller is stored uncompressed, which the library's B44
// does not handle.
static exr_result_t decompress(exr_decode_pipeline_t *d) {
  const PartReader *r = d->decoding_user_data;
  if (d->chunk.packed_size == d->chunk.unpacked_size) return EXR_ERR_SUCCESS;
  return r->decompress(d);
}

// Decodes one chunk, whose upper left pixel is (x0, y0).
static exr_result_t read_chunk(PartReader *r, const exr_chunk_info_t *chunk, int64_t x0,
                               int64_t y0) {
  // The library treats an empty chunk as decoded and would leave uninitialized memory.
  if (!chunk->packed_size || chunk->packed_size > chunk->unpacked_size)
    return EXR_ERR_CORRUPT_CHUNK;
  const bool first = !r->begun;
  exr_result_t rv = first ? exr_decoding_initialize(r->file, r->part, chunk, &r->decoder)
                          : exr_decoding_update(r->file, r->part, chunk, &r->decoder);
  if (rv) return rv;
  r->begun = true;
  r->x0 = x0;
  r->y0 = y0;
  if (first) {
    rv = exr_decoding_choose_default_routines(r->file, r->part, &r->decoder);
    if (rv) return rv;
    r->decompress = r->decoder.decompress_fn;
    if (r->decompress) r->decoder.decompress_fn = decompress;
    r->decoder.unpack_and_convert_fn = unpack;
    r->decoder.decoding_user_data = r;
  }
  // The library does not check the size of an uncompressed chunk.
  if (!r->decompress && chunk->packed_size != chunk->unpacked_size) return EXR_ERR_CORRUPT_CHUNK;
  return exr_decoding_run(r->file, r->part, &r->decoder);
}

static exr_result_t read_scanlines(PartReader *r) {
  int32_t lines = 0;
  exr_result_t rv = exr_get_scanlines_per_chunk(r->file, r->part, &lines);
  for (int64_t y = r->data.min.y; !rv && y <= r->data.max.y; y += lines) {
    exr_chunk_info_t chunk;
    if (cag_stopped()) return EXR_ERR_UNKNOWN;
    rv = exr_read_scanline_chunk_info(r->file, r->part, (int)y, &chunk);
    if (!rv) rv = read_chunk(r, &chunk, r->data.min.x, y);
  }
  return rv;
}

static exr_result_t read_tiles(PartReader *r) {
  int32_t tile_w = 0, tile_h = 0;
  exr_result_t rv = exr_get_tile_sizes(r->file, r->part, 0, 0, &tile_w, &tile_h);
  if (!rv && (tile_w < 1 || tile_h < 1)) rv = EXR_ERR_CORRUPT_CHUNK;
  if (rv) return rv;
  const int64_t width = (int64_t)r->data.max.x - r->data.min.x + 1;
  const int64_t height = (int64_t)r->data.max.y - r->data.min.y + 1;
  for (int64_t ty = 0; !rv && ty * tile_h < height; ty++) {
    for (int64_t tx = 0; !rv && tx * tile_w < width; tx++) {
      exr_chunk_info_t chunk;
      if (cag_stopped()) return EXR_ERR_UNKNOWN;
      rv = exr_read_tile_chunk_info(r->file, r->part, (int)tx, (int)ty, 0, 0, &chunk);
      if (!rv) rv = read_chunk(r, &chunk, r->data.min.x + tx * tile_w, r->data.min.y + ty * tile_h);
    }
  }
  return rv;
}

static exr_result_t read_part(exr_context_t file, int part, size_t first_channel,
                              const exr_attr_box2i_t *display, const CagImage *image) {
  PartReader r = {.file = file,
                  .part = part,
                  .image = image,
                  .first_channel = first_channel,
                  .display = *display,
                  .decoder = EXR_DECODE_PIPELINE_INITIALIZER};
  exr_storage_t storage = EXR_STORAGE_LAST_TYPE;
  exr_result_t rv = exr_get_storage(file, part, &storage);
  if (!rv) rv = exr_get_data_window(file, part, &r.data);
  if (!rv) rv = storage == EXR_STORAGE_TILED ? read_tiles(&r) : read_scanlines(&r);
  if (r.begun) exr_decoding_destroy(file, &r.decoder);
  return rv;
}

// Sets the name of a channel in the image, by the rule in the header.
static void name_channel(CagImage *image, size_t c, exr_context_t file, int part,
                         const char *channel) {
  const char *name = NULL;
  if (part == 0 || exr_get_name(file, part, &name) != EXR_ERR_SUCCESS) {
    cag_image_set_name(image, c, channel);
    return;
  }
  char full[2 * CAG_IMAGE_NAME_MAX + 2];
  size_t length = strlen(name);
  bool prefixed = !strncmp(channel, name, length) && channel[length] == '.';
  snprintf(full, sizeof full, "%.*s%s%.*s", prefixed ? 0 : CAG_IMAGE_NAME_MAX, name,
           prefixed ? "" : ".", CAG_IMAGE_NAME_MAX, channel);
  cag_image_set_name(image, c, full);
}

// Checks the channels of a part. For PIZ, PXR24, and B44, decompression depends on the channels.
// OpenEXRCore 3.1 does this incorrectly for coarser samplings, and in B44 for channels that are not
// half, up to reading out of bounds. Such files are refused.
static bool survey_channels(exr_context_t file, const Source *source, int part,
                            const exr_attr_chlist_t *list, bool *all_half, CagError *err) {
  exr_compression_t kind;
  exr_result_t rv = exr_get_compression(file, part, &kind);
  if (rv) return fail_code(err, source, rv);
  const bool b44 = kind == EXR_COMPRESSION_B44 || kind == EXR_COMPRESSION_B44A;
  const bool structured = b44 || kind == EXR_COMPRESSION_PIZ || kind == EXR_COMPRESSION_PXR24;
  for (int i = 0; i < list->num_channels; i++) {
    const exr_attr_chlist_entry_t *c = &list->entries[i];
    const bool coarse = c->x_sampling != 1 || c->y_sampling != 1;
    *all_half &= c->pixel_type == EXR_PIXEL_HALF;
    if ((structured && coarse) || (b44 && c->pixel_type != EXR_PIXEL_HALF))
      return fail_code(err, source, EXR_ERR_FEATURE_NOT_IMPLEMENTED);
  }
  return true;
}

// Checks every part, and counts all channels.
static bool survey(exr_context_t file, const Source *source, int parts, size_t *channels,
                   bool *all_half, CagError *err) {
  *channels = 0;
  *all_half = true;
  for (int p = 0; p < parts; p++) {
    exr_storage_t storage;
    const exr_attr_chlist_t *list;
    exr_result_t rv = exr_get_storage(file, p, &storage);
    if (!rv) rv = exr_get_channels(file, p, &list);
    if (rv) return fail_code(err, source, rv);
    if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED)
      return fail(err, source, "it holds deep data (several samples per pixel)");
    if (!survey_channels(file, source, p, list, all_half, err)) return false;
    *channels += (size_t)list->num_channels;
  }
  return true;
}

// Reads the header attributes whose types the list supports.
static bool read_metadata(exr_context_t file, CagExrMetadata *out, CagError *err) {
  bool ok = true;
  const exr_attribute_t *a;
  for (int32_t i = 0; ok && exr_get_attribute_by_index(file, 0, EXR_ATTR_LIST_FILE_ORDER, i, &a) ==
                                EXR_ERR_SUCCESS;
       i++) {
    if (cag_exr_name_is_reserved(a->name)) continue;
    double matrix[16];
    switch (a->type) {
    case EXR_ATTR_STRING:
      ok = cag_exr_metadata_text(out, a->name, a->string->str ? a->string->str : "", err);
      break;
    case EXR_ATTR_INT: ok = cag_exr_metadata_number(out, a->name, a->i, err); break;
    case EXR_ATTR_FLOAT: ok = cag_exr_metadata_number(out, a->name, a->f, err); break;
    case EXR_ATTR_DOUBLE: ok = cag_exr_metadata_number(out, a->name, a->d, err); break;
    case EXR_ATTR_M44F:
    case EXR_ATTR_M44D:
      for (int k = 0; k < 16; k++) {
        int from = 4 * (k % 4) + k / 4;
        matrix[k] = a->type == EXR_ATTR_M44F ? (double)a->m44f->m[from] : a->m44d->m[from];
      }
      ok = cag_exr_metadata_matrix(out, a->name, matrix, err);
      break;
    default: break;
    }
  }
  return ok;
}

static bool read_open(exr_context_t file, const Source *source, CagImage *out, bool *all_half,
                      CagError *err) {
  int parts = 0;
  exr_attr_box2i_t display;
  exr_result_t rv = exr_get_count(file, &parts);
  if (!rv) rv = exr_get_display_window(file, 0, &display);
  if (rv) return fail_code(err, source, rv);
  size_t channels;
  if (!survey(file, source, parts, &channels, all_half, err)) return false;

  int64_t width = (int64_t)display.max.x - display.min.x + 1;
  int64_t height = (int64_t)display.max.y - display.min.y + 1;
  CagError inner;
  if (!cag_image_create(out, (size_t)width, (size_t)height, channels, &inner))
    return cag_fail_io(err, inner.status, inner.help, "cannot read '%s' as EXR: %.300s",
                       source->shown, inner.message);

  size_t next = 0;
  for (int p = 0; !rv && p < parts; p++) {
    const exr_attr_chlist_t *list;
    rv = exr_get_channels(file, p, &list);
    if (rv) break;
    for (int i = 0; i < list->num_channels; i++)
      name_channel(out, next + (size_t)i, file, p, list->entries[i].name.str);
    rv = read_part(file, p, next, &display, out);
    next += (size_t)list->num_channels;
  }
  if (!rv) return true;
  cag_image_free(out);
  return fail_code(err, source, rv);
}

// Opens the bytes of `source`. If the result is 0, close it with exr_finish.
static exr_result_t open_source(Source *source, exr_context_t *file) {
  exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
  setup.error_handler_fn = cag_exr_complaint_keep;
  setup.user_data = source;
  setup.read_fn = source_read;
  setup.size_fn = source_size;
  setup.max_image_width = setup.max_image_height = (int)CAG_IMAGE_SIDE_MAX;
  setup.flags = EXR_CONTEXT_FLAG_STRICT_HEADER | EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
  return exr_start_read(file, source->shown, &setup);
}

static bool read_source(Source *source, CagImage *out, CagExrMetadata *metadata, bool *all_half,
                        CagError *err) {
  exr_context_t file;
  const exr_result_t rv = open_source(source, &file);
  if (rv) return fail_code(err, source, rv);
  bool ok = read_open(file, source, out, all_half, err);
  if (ok && metadata && !read_metadata(file, metadata, err)) {
    cag_image_free(out);
    ok = false;
  }
  exr_finish(&file);
  return ok;
}

bool cag_exr_read_pixels(const void *bytes, size_t size, const char *shown, CagImage *out,
                         CagExrMetadata *metadata, bool *all_half, CagError *err) {
  Source source = {.bytes = bytes, .size = size, .shown = shown};
  if (!size) return fail(err, &source, "the file is empty");
  if (size < sizeof MAGIC || memcmp(bytes, MAGIC, sizeof MAGIC) != 0)
    return fail(err, &source, "it is not an EXR file (it does not begin like one)");
  cag_exr_complaint_listen(&source.complaint);
  const bool ok = read_source(&source, out, metadata, all_half, err);
  cag_exr_complaint_listen(NULL);
  return ok;
}

bool cag_exr_is_whole(const void *bytes, size_t size) {
  Source source = {.bytes = bytes, .size = size, .shown = "picture"};
  exr_context_t file;
  exr_attr_box2i_t data;
  int32_t lines;
  if (size < sizeof MAGIC || memcmp(bytes, MAGIC, sizeof MAGIC) != 0 || open_source(&source, &file))
    return false;
  bool whole = exr_get_data_window(file, 0, &data) == EXR_ERR_SUCCESS &&
               exr_get_scanlines_per_chunk(file, 0, &lines) == EXR_ERR_SUCCESS && lines > 0;
  for (int64_t y = data.min.y; whole && y <= data.max.y; y += lines) {
    exr_chunk_info_t chunk;
    whole = exr_read_scanline_chunk_info(file, 0, (int)y, &chunk) == EXR_ERR_SUCCESS &&
            chunk.data_offset <= size && chunk.packed_size <= size - chunk.data_offset;
  }
  exr_finish(&file);
  return whole;
}

bool cag_exr_read_memory(const void *bytes, size_t size, const char *shown, CagImage *out,
                         CagExrMetadata *metadata, CagError *err) {
  bool all_half;
  return cag_exr_read_pixels(bytes, size, shown, out, metadata, &all_half, err);
}

static bool fail_file(CagError *err, const char *shown, const char *why) {
  return cag_fail_io(err, CAG_E_FILE, NULL, "cannot read '%s': %s", shown, why);
}

// Reads everything from an open file, whose size is only an initial estimate.
static bool slurp(int fd, const char *shown, unsigned char **bytes, size_t *size, CagError *err) {
  struct stat st;
  if (fstat(fd, &st) != 0) return fail_file(err, shown, strerror(errno));
  if (S_ISDIR(st.st_mode)) return fail_file(err, shown, "it is a folder");
  size_t capacity = st.st_size > 0 ? (size_t)st.st_size + 1 : PIPE_BLOCK;
  *bytes = NULL;
  *size = 0;
  for (;;) {
    if (*size > FILE_SIZE_MAX || capacity > 2 * FILE_SIZE_MAX)
      return fail_file(err, shown, "the file is too large");
    unsigned char *larger = cag_realloc(*bytes, capacity);
    if (!larger) return fail_file(err, shown, "not enough memory for the file");
    *bytes = larger;
    while (*size < capacity) {
      ssize_t n = read(fd, *bytes + *size, capacity - *size);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return fail_file(err, shown, strerror(errno));
      if (n == 0) return true;
      *size += (size_t)n;
    }
    capacity *= 2;
  }
}

bool cag_exr_read(const char *path, CagImage *out, CagExrMetadata *metadata, CagError *err) {
  const bool standard_input = !strcmp(path, "-");
  const char *shown = standard_input ? "standard input" : path;
  int fd = standard_input ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY);
  if (fd < 0) return fail_file(err, shown, strerror(errno));
  unsigned char *bytes = NULL;
  size_t size = 0;
  bool ok = slurp(fd, shown, &bytes, &size, err) &&
            cag_exr_read_memory(bytes, size, shown, out, metadata, err);
  cag_free(bytes);
  if (!standard_input) close(fd);
  return ok;
}
