// Writes the tables of the program as tab-separated rows of texts, for the scripts that make man
// pages, shell completions, and grammars for editors:
//
//     version  TEXT
//     command  NAME OPERANDS SUMMARY STORY
//     example  COMMAND LINE
//     option   COMMAND own|shared LETTER NAME ARGUMENT HELP
//     repl     NAME OPERAND STORY     of the commands of the REPL
//     format   NAME STORY             of exports
//     constant NAME FAMILY
//     function NAME FAMILY SIGNATURE SUMMARY
//     module   NAME                   of the standard library, as import writes it
//     error    CODE TITLE
//
// An empty field is a `-`. Options of all commands that run scripts are `shared`, others are `own`.

#include <string.h>

#include "cli/cli.h"
#include "cli/repl.h"

// Used by the parser of the command line, which is linked for its tables.
volatile int cag_tool_interrupt;

static const char *part(const char *text) { return text && *text ? text : "-"; }

static void write_commands(void) {
  for (size_t i = 0; i < CAG_TOOL_COMMAND_COUNT; i++) {
    const CagToolCommand *c = &cag_tool_commands[i];
    printf("command\t%s\t%s\t%s\t%s\n", c->name, part(c->operands), c->summary, part(c->story));
    for (const char *line = c->examples; *line;) {
      const size_t n = strcspn(line, "\n");
      printf("example\t%s\t%.*s\n", c->name, (int)n, line);
      line += n + (line[n] == '\n');
    }
  }
}

static void write_option(const char *command, const CagToolOption *o) {
  const bool shared = o->commands >> CAG_TOOL_run & 1;
  printf("option\t%s\t%s\t%c\t%s\t%s\t%s\n", command, shared ? "shared" : "own",
         o->letter ? o->letter : '-', part(o->name), part(o->argument), o->help);
}

static void write_options(void) {
  for (size_t k = 0; k < CAG_TOOL_COMMAND_COUNT; k++)
    for (size_t i = 0; i < cag_tool_option_count; i++)
      if (cag_tool_options[i].commands >> k & 1)
        write_option(cag_tool_commands[k].name, &cag_tool_options[i]);
}

static void write_repl(void) {
  const char *name, *operand, *story;
  for (size_t i = 0; cag_repl_command_row(i, &name, &operand, &story); i++)
    printf("repl\t%s\t%s\t%s\n", name, part(operand), story);
}

static void write_formats(void) {
  for (const char *const *f = cag_export_formats(); *f; f++)
    printf("format\t%s\t%s\n", *f, cag_export_format_story(*f));
}

// Writes the names of built-ins. A row without parentheses is a constant. The params that every
// script has are written as constants, too.
static void write_builtins(void) {
  static const char *const params[] = {"time", "frame", "frames"};
  const char *signature, *summary, *family;
  for (size_t i = 0; cag_builtin_row(i, &signature, &summary, NULL, &family); i++) {
    const size_t n = strcspn(signature, "(");
    if (signature[n])
      printf("function\t%.*s\t%s\t%s\t%s\n", (int)n, signature, part(family), signature,
             part(summary));
    else printf("constant\t%s\t%s\n", signature, part(family));
  }
  for (size_t i = 0; i < sizeof params / sizeof *params; i++)
    printf("constant\t%s\t-\n", params[i]);
}

static void write_errors(void) {
  const char *code, *title;
  for (size_t i = 0; cag_error_kind(i, &code, NULL, &title, NULL); i++)
    printf("error\t%s\t%s\n", code, title);
}

int main(void) {
  printf("version\t%s\n", cag_version());
  write_commands();
  write_options();
  write_repl();
  write_formats();
  write_builtins();
  const char *module;
  for (size_t i = 0; (module = cag_library_module(i)); i++) printf("module\t%s\n", module);
  write_errors();
  return ferror(stdout) || fflush(stdout) ? 1 : 0;
}
