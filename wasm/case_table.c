// Writes the upper and lower forms of characters, as utf8proc knows them, as rows of ranges for
// wasm/base/unicode.c: each has a first and last character, the step between characters, and the
// difference of their forms. Runs on the computer that compiles the playground.

#include <stdio.h>
#include <utf8proc.h>

#define CHARACTERS 0x110000

typedef utf8proc_int32_t Form(utf8proc_int32_t c);

// The next character from c on that has another form.
static int next_changed(Form *form, int c) {
  while (c < CHARACTERS && form(c) == c) c++;
  return c;
}

static void write_ranges(const char *name, Form *form) {
  printf("static const CaseRange %s[] = {\n", name);
  for (int c = next_changed(form, 0); c < CHARACTERS;) {
    const int delta = form(c) - c, second = next_changed(form, c + 1), first = c;
    const int step = second == c + 2 && form(second) - second == delta ? 2 : 1;
    while (next_changed(form, c + 1) == c + step && form(c + step) - (c + step) == delta) c += step;
    printf("    {0x%x, 0x%x, %d, %d},\n", (unsigned)first, (unsigned)c, step, delta);
    c = next_changed(form, c + 1);
  }
  puts("};");
}

int main(void) {
  write_ranges("upper_ranges", utf8proc_toupper);
  write_ranges("lower_ranges", utf8proc_tolower);
  return 0;
}
