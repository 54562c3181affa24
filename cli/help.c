// The output of --help, from the tables of commands and options.

#include <string.h>

#include "cli/cli.h"

// The columns where the second part of a line starts and where it ends.
#define TEXT_COLUMN 26
#define LAST_COLUMN 100

// Writes text, wrapped at words, from column `at` on. Further lines start at `indent`.
static void write_wrapped(const char *text, size_t at, size_t indent, FILE *out) {
  while (*text) {
    const size_t word = strcspn(text, " ");
    if (at > indent && at + 1 + word > LAST_COLUMN) {
      fprintf(out, "\n%*s", (int)indent, "");
      at = indent;
    } else if (at > indent) {
      fputc(' ', out);
      at++;
    }
    fwrite(text, 1, word, out);
    at += word;
    text += word + strspn(text + word, " ");
  }
  fputc('\n', out);
}

static void write_row(const char *left, const char *right, FILE *out) {
  fprintf(out, "  %-*s", TEXT_COLUMN - 2, left);
  if (strlen(left) > TEXT_COLUMN - 4) fprintf(out, "\n%*s", TEXT_COLUMN, "");
  write_wrapped(right, TEXT_COLUMN, TEXT_COLUMN, out);
}

// Formats the usage of an option: "-o OUT", "-h, --help", "--size WxH".
static void option_usage(const CagToolOption *o, char *text, size_t size) {
  const char letter[] = {'-', o->letter, 0};
  snprintf(text, size, "%s%s%s%s%s%s", o->letter ? letter : "", o->letter && o->name ? ", " : "",
           o->name ? "--" : "", o->name ? o->name : "", o->argument ? " " : "",
           o->argument ? o->argument : "");
}

// Writes the options of the commands in `mask`: those that several commands share, or the others.
static void write_options(unsigned mask, bool shared, FILE *out) {
  for (size_t i = 0; i < cag_tool_option_count; i++) {
    const CagToolOption *o = &cag_tool_options[i];
    const unsigned shared_by = 1u << CAG_TOOL_eval; // shared options are those of `eval`
    if (!(o->commands & mask) || (o->commands & shared_by ? !shared : shared)) continue;
    char usage[64];
    option_usage(o, usage, sizeof usage);
    write_row(usage, o->help, out);
  }
}

// Tests whether the command has options that not all script commands have.
static bool has_own_options(unsigned mask) {
  for (size_t i = 0; i < cag_tool_option_count; i++)
    if (cag_tool_options[i].commands & mask && !(cag_tool_options[i].commands >> CAG_TOOL_eval & 1))
      return true;
  return false;
}

static void write_lines(const char *text, FILE *out) {
  while (*text) {
    const size_t n = strcspn(text, "\n");
    fprintf(out, "  %.*s\n", (int)n, text);
    text += n + (text[n] == '\n');
  }
}

static void command_help(const CagToolCommand *c, FILE *out) {
  const unsigned mask = 1u << (c - cag_tool_commands);
  fprintf(out, "cag %s: %s\n\n", c->name, c->summary);
  fprintf(out, "Usage: cag %s%s%s [OPTION ...]\n", c->name, *c->operands ? " " : "", c->operands);
  if (*c->story) {
    fputc('\n', out);
    write_wrapped(c->story, 0, 0, out);
  }
  fputs("\nExamples:\n", out);
  write_lines(c->examples, out);
  if (has_own_options(mask)) {
    fputs("\nOptions:\n", out);
    write_options(mask, false, out);
  }
  fputs("\nShared options:\n", out);
  write_options(mask, true, out);
  if (strcmp(c->name, "export") != 0) return;
  fputs("\nFormats:\n", out);
  for (const char *const *f = cag_export_formats(); *f; f++)
    write_row(*f, cag_export_format_story(*f), out);
}

static void program_help(FILE *out) {
  fputs(
      "cag: turn geometry scripts into meshes, scenes, and pictures\n\nUsage: cag COMMAND [OPERAND ...] [OPTION ...]\n       cag                     work interactively\n\nCommands:\n",
      out);
  for (size_t i = 0; i < CAG_TOOL_COMMAND_COUNT; i++) {
    const CagToolCommand *c = &cag_tool_commands[i];
    char usage[64];
    snprintf(usage, sizeof usage, "%s %s", c->name, c->operands);
    write_row(usage, c->summary, out);
  }
  fputs("\nShared options:\n", out);
  write_options(~0u, true, out);
  fputs(
      "\n`cag COMMAND --help` shows the options and examples of a command. Use - for standard input or\n"
      "output, and -- to end the options.\n\n"
      "Examples:\n"
      "  cag render vase.cag -o vase.png\n"
      "  cag export vase.cag -o vase.stl -D height=200\n"
      "  cag eval 'volume(sphere(10))'\n\n"
      "Exit status:\n"
      "    0  success\n"
      "    1  the script, a test, or the comparison failed\n"
      "    2  incorrect usage\n"
      "    3  a file named on the command line could not be read or written\n"
      "    4  the renderer failed\n"
      "    5  a limit was exceeded\n"
      "  130  interrupted\n",
      out);
}

void cag_tool_help(const CagToolCommand *command, FILE *out) {
  if (command) command_help(command, out);
  else program_help(out);
}
