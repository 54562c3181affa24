// Parsing of the command line into a CagTool, by tables, and --help.

#ifndef CAG_CLI_CLI_H
#define CAG_CLI_CLI_H

#include "cli/tool.h"

// Indices of the commands, for masks: CAG_TOOL_run, ...
enum {
#define CAG_COMMAND(name, operands, least, most, summary, story, examples) CAG_TOOL_##name,
#include "cli/commands.def"
#undef CAG_COMMAND
  CAG_TOOL_COMMAND_COUNT
};

// A row of options.def.
typedef struct CagToolOption {
  const char *id;
  char letter;          // 0: no short form
  const char *name;     // without --; NULL: no long form
  const char *argument; // NULL: no argument
  unsigned commands;    // bit CAG_TOOL_name for each command that accepts it
  const char *help;
  // Stores the value. If it is invalid, reports the reason and returns false.
  bool (*set)(CagTool *t, const char *value);
} CagToolOption;

extern const CagToolCommand cag_tool_commands[CAG_TOOL_COMMAND_COUNT];
extern const CagToolOption cag_tool_options[];
extern const size_t cag_tool_option_count;

// Parses the command line into `t`, which is initialized first, and moves the operands in order to
// argv[0..count-1]. Returns false, after a message, if it is invalid. Release with
// cag_tool_release.
bool cag_tool_read(CagTool *t, int argc, char **argv, int *operand_count);
void cag_tool_release(CagTool *t);

// Writes the help of the command, or of the program if it is NULL.
void cag_tool_help(const CagToolCommand *command, FILE *out);

#endif
