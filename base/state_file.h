// Files that the program keeps for its user between runs, such as the history of the REPL.

#ifndef CAG_BASE_STATE_FILE_H
#define CAG_BASE_STATE_FILE_H

// The path of a file in $XDG_STATE_HOME/cag, by default ~/.local/state/cag. Makes missing folders,
// which only the user may enter. NULL if there is no home or no memory; else to be freed.
char *cag_state_file(const char *name);

#endif
