// The names of the definitions in a shown expression.
//
// In `lid`, `lid |> color("red")`, `translate(lid, V)`, `around(lid, 4)`, `m.lid`, and `lid(3)`, it
// is `lid`. In `[cup, lid]` and `group(cup, lid) |> scale(2)`, each part has its own.

#ifndef CAG_INTERP_SESSION_LEAD_H
#define CAG_INTERP_SESSION_LEAD_H

#include "lang/ast.h"

typedef struct CagLead {
  const char *name;    // NULL: there is no single name
  const CagExpr *expr; // without a name: the shown expression, which may have parts; or NULL
} CagLead;

// The leads of the elements of a shown list or group.
typedef struct CagLeadParts {
  CagLead each;           // for all elements, unless one of the following is set
  CagExpr *const *items;  // of a list
  CagArgument *arguments; // of a call of `group`
} CagLeadParts;

CagLead cag_lead(const CagExpr *e);
CagLeadParts cag_lead_parts(CagLead whole, size_t count);
CagLead cag_lead_part(const CagLeadParts *parts, size_t i);

#endif
