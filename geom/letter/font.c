#include "geom/letter/font.h"

#include <limits.h>
#include <stdio.h>

#include "base/memory.h"
#include "geom/letter/outline.h"

// The height of capitals of a font without an H, in ems.
#define CAPITAL 0.7
// What HarfBuzz takes for a font: tables of its own, and accelerators of those of the file.
#define BYTES_PER_FONT 65536

const char *const cag_font_styles[CAG_FONT_STYLE_COUNT] = {
#define X(name, text) text,
    CAG_FONT_STYLES(X)
#undef X
};

static bool has_table(const hb_face_t *face, hb_tag_t tag) {
  hb_blob_t *table = cag_hb.face_reference_table(face, tag);
  const bool has = cag_hb.blob_get_length(table) > 0;
  cag_hb.blob_destroy(table);
  return has;
}

static bool has_outlines(const hb_face_t *face) {
  return has_table(face, HB_TAG('g', 'l', 'y', 'f')) ||
         has_table(face, HB_TAG('C', 'F', 'F', ' ')) || has_table(face, HB_TAG('C', 'F', 'F', '2'));
}

static void measure_lines(CagFont *f) {
  hb_font_extents_t lines;
  if (cag_hb.font_get_h_extents(f->hb, &lines)) {
    f->ascender = lines.ascender;
    f->descender = -lines.descender;
    f->gap = lines.line_gap;
  }
  if (!(f->ascender + f->descender > 0)) {
    f->ascender = 0.8 * f->em;
    f->descender = 0.2 * f->em;
  }
  if (f->gap < 0) f->gap = 0;
}

static CagStatus measure_capitals(CagFont *f, CagError *err) {
  hb_codepoint_t glyph;
  CagBounds box = CAG_BOUNDS_EMPTY;
  f->capital = CAPITAL * f->em;
  if (!cag_hb.font_get_nominal_glyph(f->hb, 'H', &glyph)) return CAG_OK;
  CagStatus status = cag_glyph_bounds(f, glyph, &box, err);
  if (!status && box.max.y > 0) f->capital = box.max.y;
  return status;
}

static CagStatus unreadable(const char *name, const char *why, CagError *err) {
  return cag_fail(err, CAG_E_ARGUMENT, CAG_ERR_font_unreadable, "font", -1,
                  "the font \"%s\" cannot be used: %s", name, why);
}

static CagStatus use_face(CagFont *f, hb_face_t *face, CagError *err) {
  if (cag_hb.face_get_glyph_count(face) == 0) return unreadable(f->name, "it has no glyphs", err);
  if (!has_outlines(face))
    return unreadable(f->name, "it has no outlines in a format that can be read", err);
  f->hb = cag_hb.font_create(face);
  f->em = cag_hb.face_get_upem(face);
  cag_hb.font_set_scale(f->hb, (int)f->em, (int)f->em);
  measure_lines(f);
  return measure_capitals(f, err);
}

CagStatus cag_font_new(const char *name, const void *bytes, size_t size, unsigned index,
                       CagFont *out, CagError *err) {
  *out = (CagFont){.hb = NULL};
  snprintf(out->name, sizeof out->name, "%s", name);
  CagStatus status = cag_letter_libraries(err);
  if (status) return status;
  if (size > UINT_MAX) return unreadable(name, "the file is too large", err);
  if (!cag_account_hold(BYTES_PER_FONT)) return cag_fail_memory(err);
  out->held = BYTES_PER_FONT;
  hb_blob_t *blob = cag_hb.blob_create(bytes, (unsigned)size, HB_MEMORY_MODE_READONLY, NULL, NULL);
  if (index >= cag_hb.face_count(blob)) {
    status = unreadable(name, "it is not a TrueType or OpenType font", err);
  } else {
    hb_face_t *face = cag_hb.face_create(blob, index);
    status = use_face(out, face, err);
    cag_hb.face_destroy(face); // the font keeps it
  }
  cag_hb.blob_destroy(blob);
  if (status) cag_font_free(out);
  return status;
}

CagStatus cag_font_compiled_in(CagFontStyle style, CagFont *out, CagError *err) {
  CagFontFile file;
  *out = (CagFont){.hb = NULL};
  CagStatus status = cag_font_compiled_file(style, &file, err);
  if (status) return status;
  return cag_font_new(CAG_FONT_SANS, file.bytes, file.size, 0, out, err);
}

void cag_font_free(CagFont *f) {
  if (f->hb) cag_hb.font_destroy(f->hb);
  for (size_t i = 0; i < f->glyph_count; i++) cag_region_release(f->glyphs[i].region);
  cag_free(f->glyphs);
  cag_hash_free(&f->glyph_index);
  cag_account_drop(f->held);
  *f = (CagFont){.hb = NULL};
}
