// The command line: its tables, read into a CagTool, and their --help.

#ifndef CAG_CLI_CLI_H
#define CAG_CLI_CLI_H

#include "cli/tool.h"

// Numbers of the commands, for masks: CAG_TOOL_run, ...
enum {
#define CAG_COMMAND(name, operands, least, most, summary, story, examples) CAG_TOOL_##name,
#include "cli/commands.def"
#undef CAG_COMMAND
  CAG_TOOL_COMMAND_COUNT
};

// A row of options.def.
typedef struct CagToolOption {
  const char *id;
  char letter;          // 0: none
  const char *name;     // without its --; NULL: none
  const char *argument; // NULL: takes none
  unsigned commands;    // bit CAG_TOOL_name for each command that takes it
  const char *help;
  // Keeps the value, or says what is wrong with it and gives back false.
  bool (*set)(CagTool *t, const char *value);
} CagToolOption;

extern const CagToolCommand cag_tool_commands[CAG_TOOL_COMMAND_COUNT];
extern const CagToolOption cag_tool_options[];
extern const size_t cag_tool_option_count;

// Reads the command line into `t` (which it initializes), with the operands in order in
// argv[0..count-1]. False, after a message, when it makes no sense; nothing has been done then.
// What it took is released by cag_tool_release.
bool cag_tool_read(CagTool *t, int argc, char **argv, int *operand_count);
void cag_tool_release(CagTool *t);

// Writes the help of the command, or of the program for NULL.
void cag_tool_help(const CagToolCommand *command, FILE *out);

#endif
