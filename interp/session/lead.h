// The name of a definition to which a shown expression leads.
//
// `lid`, `lid |> color("red")`, `translate(lid, V)`, `around(lid, 4)`, `m.lid` and `lid(3)` lead to
// `lid`; `[cup, lid]` and `group(cup, lid) |> scale(2)` do so part by part.

#ifndef CAG_INTERP_SESSION_LEAD_H
#define CAG_INTERP_SESSION_LEAD_H

#include "lang/ast.h"

typedef struct CagLead {
  const char *name;    // NULL: not to one name
  const CagExpr *expr; // where there is none: what was shown, which may have parts; or NULL
} CagLead;

// The leads of the elements of a shown list or group of a number of elements.
typedef struct CagLeadParts {
  CagLead each;           // of all of them, unless one of these is there
  CagExpr *const *items;  // of a list
  CagArgument *arguments; // of a call of `group`
} CagLeadParts;

CagLead cag_lead(const CagExpr *e);
CagLeadParts cag_lead_parts(CagLead whole, size_t count);
CagLead cag_lead_part(const CagLeadParts *parts, size_t i);

#endif
