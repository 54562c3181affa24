// Documents and their printer (layout.h).

#include "lang/layout.h"

#include <string.h>

#include "base/arena.h"
#include "base/array.h"
#include "base/memory.h"

// Comments at the ends of neighboring lines are aligned if the code of all these lines ends before
// this column.
#define ALIGN_UNTIL 72
#define COMMENT_GAP 2

// ---- memory ----

#define BLOCK_SIZE ((size_t)64 * 1024)

struct LayoutBlock {
  LayoutBlock *next;
  size_t used, size;
  _Alignas(max_align_t) char bytes[];
};

void cag_layout_init(Layout *l, const CagSource *source, uint32_t width) {
  *l = (Layout){.source = source, .width = width};
}

static LayoutBlock *next_block(Layout *l, size_t size) {
  cag_source_check(l->source);
  LayoutBlock *b = l->block ? l->block->next : l->blocks;
  if (b && b->size >= size) return b;
  const size_t room = size > BLOCK_SIZE ? size : BLOCK_SIZE;
  LayoutBlock *made = cag_checked(cag_malloc(sizeof *made + room));
  made->size = room;
  made->next = b;
  if (l->block) l->block->next = made;
  else l->blocks = made;
  return made;
}

static size_t rounded(size_t size) {
  return (size + _Alignof(max_align_t) - 1) / _Alignof(max_align_t) * _Alignof(max_align_t);
}
#define DOC_SIZE rounded(sizeof(Doc))

void *cag_layout_memory(Layout *l, size_t size) {
  size = rounded(size);
  if (!l->block || l->block->size - l->block->used < size) {
    l->block = next_block(l, size);
    l->block->used = 0;
  }
  void *memory = l->block->bytes + l->block->used;
  l->block->used += size;
  return memory;
}

// ---- documents ----

static uint32_t sum(uint32_t a, uint32_t b) { return a + b < DOC_ENDLESS ? a + b : DOC_ENDLESS; }

static inline Doc *new_doc(Layout *l, DocKind kind) {
  LayoutBlock *b = l->block;
  Doc *d;
  if (b && b->size - b->used >= DOC_SIZE) {
    d = (Doc *)(void *)(b->bytes + b->used);
    b->used += DOC_SIZE;
  } else {
    d = cag_layout_memory(l, sizeof *d);
  }
  *d = (Doc){.kind = (uint8_t)kind};
  return d;
}

static uint32_t code_points(const char *text, size_t length) {
  uint32_t n = 0;
  for (size_t i = 0; i < length; i++) n += ((unsigned char)text[i] & 0xC0) != 0x80;
  return n;
}

Doc *cag_layout_plain(Layout *l, const char *word, size_t length) {
  Doc *d = new_doc(l, DOC_TEXT);
  d->text = word;
  d->length = d->first = d->width = (uint32_t)length;
  return d;
}

Doc *cag_layout_text(Layout *l, const char *text, size_t length) {
  Doc *d = cag_layout_plain(l, text, length);
  size_t plain = 0;
  while (plain < length && (signed char)text[plain] > '\n') plain++; // otherwise UTF-8, or a break
  if (plain == length) return d;
  const char *end = memchr(text, '\n', length);
  d->first = code_points(text, end ? (size_t)(end - text) : length);
  d->width = end ? DOC_ENDLESS : d->first;
  d->breaks = end != NULL;
  return d;
}

Doc *cag_layout_space(Layout *l) {
  Doc *d = new_doc(l, DOC_LINE);
  d->text = " ";
  d->length = d->width = 1;
  d->breaks = true;
  return d;
}

static Doc *breaking(Layout *l, DocKind kind, Doc *child) {
  Doc *d = new_doc(l, kind);
  d->width = DOC_ENDLESS;
  d->breaks = true;
  d->child = child;
  return d;
}

Doc *cag_layout_hard(Layout *l) { return breaking(l, DOC_HARD, NULL); }
Doc *cag_layout_blank(Layout *l) { return breaking(l, DOC_BLANK, NULL); }
Doc *cag_layout_trailing(Layout *l, Doc *text) { return breaking(l, DOC_TRAILING, text); }
Doc *cag_layout_comment(Layout *l, Doc *text) { return breaking(l, DOC_COMMENT, text); }

Doc *cag_layout_inline(Layout *l, Doc *text) {
  Doc *d = breaking(l, DOC_INLINE, text);
  d->width = text->width < DOC_ENDLESS ? text->width + 1 : DOC_ENDLESS;
  d->first = text->first + 1;
  d->breaks = text->breaks;
  return d;
}

static Doc *parent(Layout *l, DocKind kind, Doc *child) {
  uint32_t width = 0, first = 0;
  bool breaks = false;
  for (const Doc *c = child; c; c = c->next) {
    width = sum(width, c->width);
    if (!breaks) first += c->first;
    breaks = breaks || c->breaks;
  }
  Doc *d = new_doc(l, kind);
  d->child = child;
  d->width = width;
  d->first = first;
  d->breaks = breaks;
  return d;
}

Doc *cag_layout_concat(Layout *l, const Docs *parts) {
  if (parts->head && !parts->head->next) return parts->head;
  return parent(l, DOC_CONCAT, parts->head);
}

void cag_layout_comma(Doc *d) {
  d->comma = true;
  d->width = sum(d->width, 1);
  if (!d->breaks) d->first++;
}

Doc *cag_layout_group(Layout *l, Doc *d) { return parent(l, DOC_GROUP, d); }

Doc *cag_layout_stages(Layout *l, Doc *head, Doc *rest) {
  head->next = rest;
  return parent(l, DOC_STAGES, head);
}

Doc *cag_layout_nest(Layout *l, int indent, const Docs *parts) {
  Doc *d = parent(l, DOC_NEST, parts->head);
  d->indent = indent;
  return d;
}

Doc *cag_layout_fill(Layout *l, int indent, const Docs *items) {
  Doc *d = parent(l, DOC_FILL, items->head);
  d->indent = indent;
  return d;
}

Doc *cag_layout_brackets(Layout *l, char open, const Docs *items, Doc *close, int indent,
                         bool padded, bool hugs) {
  Doc *d = parent(l, DOC_BRACKETS, items->head);
  d->bracket = open;
  d->padded = padded;
  d->close = close;
  d->indent = indent;
  d->hugs = hugs;
  d->width = sum(sum(d->width, padded ? 3 : 1), close->width);
  d->first = 1 + (items->head ? 0 : close->first);
  d->breaks = items->head || close->breaks;
  return d;
}

Doc *cag_layout_filled(Layout *l, char open, const Docs *items, Doc *close, int indent,
                       bool padded) {
  Doc *d = cag_layout_brackets(l, open, items, close, indent, padded, false);
  d->kind = DOC_FILLED;
  return d;
}

static const Doc *last_of(const Doc *child) {
  while (child && child->next) child = child->next;
  return child;
}

// ---- tables ----

static bool is_leaf(const Doc *d) { return d->kind <= DOC_INLINE; }
static bool is_brackets(const Doc *d) { return d->kind >= DOC_BRACKETS; }

// Returns the brackets of an item of a table, after its comments.
static const Doc *row_of(const Doc *item) {
  return item->kind == DOC_CONCAT ? last_of(item->child) : item;
}

static uint32_t word_width(const Doc *d) { return d->width - d->comma; }

// Increases the widths of columns to those of the words of a row. Returns the position after the
// last one.
static uint32_t *widen_columns(const Doc *d, uint32_t *widths) {
  if (!is_brackets(d)) {
    if (*widths < word_width(d)) *widths = word_width(d);
    return widths + 1;
  }
  for (const Doc *c = d->child; c; c = c->next)
    if (c->kind != DOC_LINE) widths = widen_columns(c, widths);
  return widths;
}

static const uint32_t *pad_words(Doc *d, const uint32_t *widths) {
  if (!is_brackets(d)) {
    d->pad = *widths - word_width(d);
    return widths + 1;
  }
  for (Doc *c = d->child; c; c = c->next)
    if (c->kind != DOC_LINE) widths = pad_words(c, widths);
  return widths;
}

Doc *cag_layout_table(Layout *l, char open, const Docs *items, Doc *close, int indent,
                      size_t words) {
  uint32_t *widths = cag_layout_memory(l, words * sizeof *widths);
  memset(widths, 0, words * sizeof *widths);
  for (const Doc *item = items->head; item; item = item->next)
    if (!is_leaf(item)) widen_columns(row_of(item), widths);
  for (const Doc *item = items->head; item; item = item->next)
    if (!is_leaf(item)) pad_words((Doc *)row_of(item), widths);
  Doc *d = cag_layout_brackets(l, open, items, close, indent, false, false);
  d->kind = DOC_TABLE;
  return d;
}

// ---- printing ----

static void reserve(Layout *l, size_t n) {
  if (l->capacity - l->length >= n) return;
  const size_t capacity = (l->length + n) * 2 + 4096;
  l->out = cag_checked(cag_realloc(l->out, capacity));
  l->capacity = capacity;
}

static inline void put(Layout *l, const char *bytes, size_t n) {
  if (!n) return;
  reserve(l, n);
  if (n == 1) l->out[l->length] = *bytes; // most words have one byte
  else memcpy(l->out + l->length, bytes, n);
  l->length += n;
}

static void strip_spaces(Layout *l) {
  for (; l->length && l->out[l->length - 1] == ' '; l->length--) l->column--;
}

static void break_line(Layout *l) {
  static const char spaces[] = "                                                                ";
  strip_spaces(l);
  if (l->length) {
    put(l, "\n\n", l->blank ? 2 : 1);
    l->line += l->blank ? 2 : 1;
  }
  for (int n = l->pending_indent; n > 0; n -= (int)sizeof spaces - 1)
    put(l, spaces, n < (int)sizeof spaces ? (size_t)n : sizeof spaces - 1);
  l->column = l->indent = (uint32_t)l->pending_indent;
  l->pending = l->blank = l->closed = false;
}

// Writes a word without line breaks that is `columns` wide.
static inline void put_word(Layout *l, const char *word, size_t length, uint32_t columns) {
  if (!length) return;
  if (l->pending) break_line(l);
  put(l, word, length);
  l->column += columns;
}

static void put_text(Layout *l, const Doc *d) {
  if (!d->breaks) {
    put_word(l, d->text, d->length, d->first - d->comma);
    return;
  }
  const char *text = d->text;
  size_t length = d->length;
  if (l->pending) break_line(l);
  put(l, text, length);
  for (const char *end; (end = memchr(text, '\n', length)); l->column = 0, l->line++) {
    length -= (size_t)(end + 1 - text);
    text = end + 1;
  }
  l->column += code_points(text, length);
}

static void put_line(Layout *l, int indent) {
  l->pending = true;
  l->pending_indent = indent;
}

static uint32_t column(const Layout *l) {
  return l->pending ? (uint32_t)l->pending_indent : l->column;
}

static bool fits(const Layout *l, const Doc *d, uint32_t tail) {
  return column(l) + d->width + tail <= l->width;
}

static void put_comment(Layout *l, const Doc *text, int indent) {
  if (l->length) put_line(l, indent);
  put_text(l, text);
  put_line(l, indent);
  l->closed = true;
}

// Returns the common column for the pending comments of neighboring lines, or 0 if some code is too
// long.
static uint32_t common_column(const Layout *l) {
  uint32_t most = 0;
  for (size_t i = 0; i < l->trailing_count; i++)
    if (l->trailing[i].column > most) most = l->trailing[i].column;
  return most <= ALIGN_UNTIL ? most : 0;
}

static size_t gap_before(const LayoutTrailing *t, uint32_t column) {
  return (column > t->column ? column - t->column : 0) + COMMENT_GAP;
}

// Moves the pending comments to their column, starting with the last one.
static void align_trailing(Layout *l) {
  const uint32_t column = common_column(l);
  size_t moved = 0, end = l->length;
  for (size_t i = 0; i < l->trailing_count; i++) moved += gap_before(&l->trailing[i], column);
  reserve(l, moved);
  l->length += moved;
  for (size_t i = l->trailing_count; i-- > 0;) {
    const size_t at = l->trailing[i].at, gap = gap_before(&l->trailing[i], column);
    memmove(l->out + at + moved, l->out + at, end - at);
    moved -= gap;
    memset(l->out + at + moved, ' ', gap);
    end = at;
  }
  l->trailing_count = 0;
}

// Tests whether a comment at the end of this line is aligned with the last pending one.
static bool joins_trailing(const Layout *l) {
  const LayoutTrailing *last = &l->trailing[l->trailing_count - 1];
  return l->line == last->line + 1 && l->indent == last->indent;
}

static void put_trailing(Layout *l, const Doc *text, int indent) {
  if (!l->length || l->closed) {
    put_comment(l, text, indent);
    return;
  }
  strip_spaces(l);
  if (text->text[1] == '*') {
    put(l, " ", 1);
    put(l, text->text, text->length);
    l->column += 1 + code_points(text->text, text->length);
    put_line(l, indent);
    return;
  }
  if (l->trailing_count && !joins_trailing(l)) align_trailing(l);
  if (!CAG_RESERVE(l->trailing, l->trailing_capacity, l->trailing_count + 1)) cag_memory_leave();
  l->trailing[l->trailing_count++] = (LayoutTrailing){l->length, l->line, l->column, l->indent};
  put(l, text->text, text->length);
  l->closed = true;
  put_line(l, indent);
}

static void print(Layout *l, const Doc *d, int indent, uint32_t tail);
static void print_flat(Layout *l, const Doc *d);

// Returns the width after d up to the next possible break.
static uint32_t behind(const Doc *d, uint32_t tail) {
  uint32_t width = 0;
  for (d = d->next; d; d = d->next) {
    width += d->first;
    if (d->breaks) return width;
  }
  return width + tail;
}

static void print_children(Layout *l, const Doc *child, int indent, uint32_t tail) {
  for (; child; child = child->next)
    print(l, child, indent, is_leaf(child) ? 0 : behind(child, tail));
}

// `rest`: the indentation of the lines after the first one. `apart`: items that must be broken are
// on separate lines.
static void print_fill(Layout *l, const Doc *child, int indent, int rest, uint32_t tail,
                       bool apart) {
  for (bool whole = true; child; child = child->next, indent = rest) {
    if (child->kind == DOC_LINE && child->next) {
      const Doc *item = child->next;
      const uint32_t after = item->next ? 0 : tail;
      const bool stays = whole && item->kind != DOC_BLANK && item->kind != DOC_HARD &&
                         column(l) + child->width + item->width + after <= l->width;
      if (stays) print_flat(l, child);
      else print(l, child, indent, 0);
    } else {
      whole = apart ? fits(l, child, 0) : child->width < DOC_ENDLESS;
      print(l, child, indent, child->next ? 0 : tail);
    }
  }
}

// Tests whether all items but the last fit on this line, and the last one can start on it.
static bool hugs(const Layout *l, const Doc *d, int indent) {
  const Doc *last = last_of(d->child);
  if (!d->hugs || !last) return false;
  uint32_t width = column(l);
  for (const Doc *c = d->child; c != last; c = c->next) width = sum(width, c->width);
  if (width + last->first > l->width) return false;
  return d->child == last || (uint32_t)(indent + d->indent) + last->width + 1 > l->width;
}

// Tests whether all items fit on the line below the bracket.
static bool gathers(const Layout *l, const Doc *d, int indent) {
  uint32_t width = (uint32_t)(indent + d->indent);
  if (!d->gathers) return false;
  for (const Doc *c = d->child; c; c = c->next) width = sum(width, c->width);
  return width <= l->width;
}

// Items after the first one are short if they are at most this wide together.
#define REST_MAX 40

// Tests whether the first item starts on the line of the bracket, and the rest follows its end.
static bool opens(const Layout *l, const Doc *d, int indent) {
  if (!d->opens || gathers(l, d, indent)) return false;
  uint32_t rest = 0;
  for (const Doc *c = d->child->next; c; c = c->next) rest = sum(rest, c->width);
  return rest <= REST_MAX && column(l) + d->child->first <= l->width;
}

static void put_inline(Layout *l, const Doc *text) {
  if (!l->pending && l->length && !strchr(" ([{", l->out[l->length - 1])) put_word(l, " ", 1, 1);
  put_text(l, text);
}

// Prints the documents from `c` up to `end` on one line.
static void print_all_flat(Layout *l, const Doc *c, const Doc *end) {
  for (; c != end; c = c->next) print_flat(l, c);
}

// Prints a document on one line.
static void print_flat(Layout *l, const Doc *d) {
  switch (d->kind) {
  case DOC_TEXT:
  case DOC_LINE: put_word(l, d->text, d->length, d->width - d->comma); break;
  case DOC_INLINE: put_inline(l, d->child); break;
  case DOC_BRACKETS:
  case DOC_FILLED:
  case DOC_TABLE:
    put_word(l, &d->bracket, 1, 1);
    if (d->padded) put_word(l, " ", 1, 1);
    print_all_flat(l, d->child, NULL);
    if (d->padded) put_word(l, " ", 1, 1);
    print_flat(l, d->close);
    break;
  default: print_all_flat(l, d->child, NULL);
  }
  if (d->comma) put_word(l, ",", 1, 1);
}

static uint32_t aligned_width(const Doc *d) {
  if (!is_brackets(d)) return d->pad + d->width;
  uint32_t width = 1 + d->comma + d->close->width;
  for (const Doc *c = d->child; c; c = c->next)
    width += c->kind == DOC_LINE ? c->width : aligned_width(c);
  return width;
}

static void print_aligned(Layout *l, const Doc *d) {
  if (!is_brackets(d)) {
    for (uint32_t i = 0; i < d->pad; i++) put_word(l, " ", 1, 1);
    print_flat(l, d);
    return;
  }
  put_word(l, &d->bracket, 1, 1);
  for (const Doc *c = d->child; c; c = c->next) {
    if (c->kind == DOC_LINE) print_flat(l, c);
    else print_aligned(l, c);
  }
  print_flat(l, d->close);
  if (d->comma) put_word(l, ",", 1, 1);
}

// Prints the rows of a table, each on one line if it is long enough.
static void print_rows(Layout *l, const Doc *item, int indent) {
  for (; item; item = item->next) {
    const Doc *row = is_leaf(item) ? NULL : row_of(item);
    const bool comma = row != item && item->comma; // not included in the row's width
    if (!row || (uint32_t)indent + aligned_width(row) + comma > l->width) {
      print(l, item, indent, 0);
      continue;
    }
    if (row != item)
      for (const Doc *c = item->child; c != row; c = c->next) print(l, c, indent, 0);
    print_aligned(l, row);
    if (comma) put_word(l, ",", 1, 1);
  }
}

static void print_brackets(Layout *l, const Doc *d, int indent, uint32_t tail) {
  put_word(l, &d->bracket, 1, 1);
  if (hugs(l, d, indent)) {
    const Doc *last = last_of(d->child);
    print_all_flat(l, d->child, last);
    print(l, last, indent, d->close->first + tail);
  } else if (opens(l, d, indent)) {
    print(l, d->child, indent, 0);
    print_all_flat(l, d->child->next, NULL);
  } else if (d->child) {
    const int inner = indent + d->indent;
    put_line(l, inner);
    if (d->kind == DOC_FILLED) print_fill(l, d->child, inner, inner, 0, true);
    else if (d->kind == DOC_TABLE) print_rows(l, d->child, inner);
    else if (gathers(l, d, indent)) print_all_flat(l, d->child, NULL);
    else print_children(l, d->child, inner, 0);
    if (d->close->kind == DOC_CONCAT) { // comments before the bracket are indented like the items
      const Doc *bracket = last_of(d->close->child);
      for (const Doc *c = d->close->child; c != bracket; c = c->next) print(l, c, inner, 0);
      put_line(l, indent);
      print(l, bracket, indent, 0);
      return;
    }
    put_line(l, indent);
  }
  print(l, d->close, indent, tail);
}

// Tests whether the line so far consists of one or two closing brackets.
static bool has_just_closed(const Layout *l, int indent) {
  return !l->pending && l->length && strchr(")]}", l->out[l->length - 1]) &&
         l->column <= (uint32_t)indent + 2;
}

// Tests whether a single stage that does not fit on a line can start directly after its head, and
// break within its own brackets.
static bool begins_behind(const Layout *l, const Doc *head, const Doc *rest, int indent) {
  const Doc *stage = rest->child->next->next; // after a LINE and `|> `
  if (!stage || stage->next || stage->kind != DOC_CONCAT || !is_brackets(last_of(stage->child)))
    return false;
  const uint32_t sign = rest->child->next->width;
  return sum((uint32_t)(indent + rest->indent) + sign, stage->width) > l->width &&
         sum(column(l) + head->width, rest->child->width + sign + stage->first) <= l->width;
}

static void print_stages(Layout *l, const Doc *head, int indent, uint32_t tail) {
  const Doc *rest = head->next;
  if (begins_behind(l, head, rest, indent)) {
    const Doc *stage = last_of(rest->child);
    print_flat(l, head);
    print_all_flat(l, rest->child, stage);
    print(l, stage, indent, tail);
    return;
  }
  print(l, head, indent, behind(head, tail));
  if (has_just_closed(l, indent) && fits(l, rest, tail)) print_flat(l, rest);
  else print(l, rest, indent, tail);
}

static void print_broken(Layout *l, const Doc *d, int indent, uint32_t tail) {
  switch (d->kind) {
  case DOC_TEXT: put_text(l, d); break;
  case DOC_LINE:
  case DOC_HARD: put_line(l, indent); break;
  case DOC_BLANK:
    put_line(l, indent);
    l->blank = true;
    break;
  case DOC_TRAILING: put_trailing(l, d->child, indent); break;
  case DOC_COMMENT: put_comment(l, d->child, indent); break;
  case DOC_INLINE: put_inline(l, d->child); break;
  case DOC_CONCAT:
  case DOC_GROUP: print_children(l, d->child, indent, tail); break;
  case DOC_STAGES: print_stages(l, d->child, indent, tail); break;
  case DOC_NEST: print_children(l, d->child, indent + d->indent, tail); break;
  case DOC_FILL: print_fill(l, d->child, indent, indent + d->indent, tail, false); break;
  case DOC_BRACKETS:
  case DOC_FILLED:
  case DOC_TABLE: print_brackets(l, d, indent, tail); break;
  }
}

// Prints d, which is followed by `tail` columns before the next possible break.
static void print(Layout *l, const Doc *d, int indent, uint32_t tail) {
  cag_source_check(l->source);
  if (d->kind >= DOC_GROUP && fits(l, d, tail)) {
    print_flat(l, d);
    return;
  }
  print_broken(l, d, indent, tail + d->comma);
  if (d->comma) put_word(l, ",", 1, 1);
}

void cag_layout_print(Layout *l, Doc *d) {
  if (l->trailing_count && l->line > l->trailing[l->trailing_count - 1].line + 1) align_trailing(l);
  print(l, d, 0, 0);
  if (l->length) put_line(l, 0);
  l->block = l->blocks;
  if (l->block) l->block->used = 0;
}

char *cag_layout_finish(Layout *l, size_t *length) {
  if (l->trailing_count) align_trailing(l);
  if (l->length) put(l, "\n", 1);
  reserve(l, 1);
  l->out[l->length] = 0;
  *length = l->length;
  char *out = l->out;
  l->out = NULL;
  return out;
}

void cag_layout_release(Layout *l) {
  cag_free(l->out);
  cag_free(l->trailing);
  while (l->blocks) {
    LayoutBlock *next = l->blocks->next;
    cag_free(l->blocks);
    l->blocks = next;
  }
}
