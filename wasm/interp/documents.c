// The chapters of the guide are beside the playground, and not in the program.

#include "interp/doc/doc.h"

const CagDocument cag_documents[] = {{0}};
