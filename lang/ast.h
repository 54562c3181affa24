// The syntax tree, as built by the parser and annotated by the resolver.
//
// All nodes are in the arena of their CagModuleAst and are freed with it. Names are in NFC and
// interned in that arena: equal names of a tree are the same pointer. The tree keeps the source
// form (pipes, parentheses, units) for the formatter. Nothing is desugared here.

#ifndef CAG_LANG_AST_H
#define CAG_LANG_AST_H

#include "base/arena.h"
#include "base/diagnostic.h"
#include "base/source.h"

typedef struct CagExpr CagExpr;
typedef struct CagDecl CagDecl;
typedef struct CagFunctionAst CagFunctionAst;
typedef struct CagPattern CagPattern;

typedef enum CagExprKind {
  CAG_EXPR_NUMBER,   // number (a length unit has been applied: 2.5cm is 25)
  CAG_EXPR_ANGLE,    // number: degrees
  CAG_EXPR_TEXT,     // text
  CAG_EXPR_TEMPLATE, // list: alternating texts and expressions
  CAG_EXPR_TRUE,
  CAG_EXPR_FALSE,
  CAG_EXPR_NONE,
  CAG_EXPR_NAME,          // name
  CAG_EXPR_GROUP,         // unary.operand: an expression in parentheses
  CAG_EXPR_LIST,          // list (items may be SPREAD)
  CAG_EXPR_SPREAD,        // unary.operand; only as an item of LIST or as a field of RECORD
  CAG_EXPR_COMPREHENSION, // comprehension
  CAG_EXPR_RECORD,        // record
  CAG_EXPR_BLOCK,         // block
  CAG_EXPR_LAMBDA,        // function
  CAG_EXPR_IF,            // branch
  CAG_EXPR_NEGATE,        // unary
  CAG_EXPR_NOT,           // unary
  CAG_EXPR_BINARY,        // binary
  CAG_EXPR_AND,           // binary
  CAG_EXPR_OR,            // binary
  CAG_EXPR_PIPE,          // binary: left |> right
  CAG_EXPR_RANGE,         // range
  CAG_EXPR_CALL,          // call
  CAG_EXPR_INDEX,         // binary: left[right]
  CAG_EXPR_MEMBER,        // member
  CAG_EXPR_ERROR          // replaces an expression that could not be parsed
} CagExprKind;

typedef enum CagBinaryOp {
  CAG_OP_ADD,
  CAG_OP_SUBTRACT,
  CAG_OP_MULTIPLY,
  CAG_OP_DIVIDE,
  CAG_OP_MODULO,
  CAG_OP_POWER,
  CAG_OP_UNION,        // |
  CAG_OP_INTERSECTION, // &
  CAG_OP_EQUAL,
  CAG_OP_NOT_EQUAL,
  CAG_OP_LESS,
  CAG_OP_LESS_EQUAL,
  CAG_OP_GREATER,
  CAG_OP_GREATER_EQUAL,
  CAG_OP_IN
} CagBinaryOp;

typedef struct CagArgument {
  const char *name; // NULL: positional
  CagSpan name_span;
  CagExpr *value;
} CagArgument;

typedef struct CagField {
  const char *name; // NULL: a spread, whose operand is value
  CagSpan name_span;
  CagExpr *value;
} CagField;

typedef enum CagPatternKind {
  CAG_PATTERN_NAME,  // decl
  CAG_PATTERN_LIST,  // parts, rest
  CAG_PATTERN_RECORD // parts
} CagPatternKind;

// An element of a list pattern, or a field of a record pattern. The pattern of a field without `:`
// is a name with the span of the field.
typedef struct CagPatternPart {
  const char *field; // NULL: an element
  CagSpan field_span;
  CagPattern *pattern;
} CagPatternPart;

// What takes a value apart and names its parts: a name, [x, ...rest], or {a, b: [x, y]}.
struct CagPattern {
  CagPatternKind kind;
  CagSpan span;
  CagDecl *decl; // NAME: its name may be `_`
  CagPatternPart *parts;
  size_t count;
  CagDecl *rest;     // LIST: the name after `...`, which may be `_`; NULL: none
  CagSpan rest_span; // with its dots
  // Of the outermost pattern: all its names in order, without `_`.
  CagDecl **names;
  size_t name_count;
};

// One `x in xs if c` or `[a, b] in xs if c` of a comprehension.
typedef struct CagClause {
  CagPattern *pattern;
  CagExpr *source;
  CagExpr *filter; // NULL: none
  CagSpan span;
} CagClause;

// A definition or an assert of a block or of a module.
typedef struct CagStatement CagStatement;

// What a name can refer to.
typedef enum CagDeclKind {
  CAG_DECL_TOP,       // definition or param of the module
  CAG_DECL_IMPORT,    // `import m`: the module itself
  CAG_DECL_IMPORTED,  // `import m: a`: a name of another module
  CAG_DECL_PARAMETER, // of a function
  CAG_DECL_BLOCK,     // definition in a block
  CAG_DECL_CLAUSE     // name of a comprehension
} CagDeclKind;

struct CagDecl {
  CagDeclKind kind;
  const char *name;
  CagSpan span;            // of the name
  CagFunctionAst *owner;   // innermost enclosing function; NULL at the top level of the module (set
                           // by the resolver)
  CagStatement *statement; // TOP, BLOCK, IMPORT, IMPORTED: the statement that declares it
  size_t index; // TOP: its index among the module's tops; otherwise free for use by the compiler
  bool used;
  bool whole; // stands for the value of a pattern, whose text is its name; no name refers to it
  const char *doc; // TOP: text of the /// lines before it; NULL: none
};

typedef struct CagParameter {
  CagDecl *decl;       // its name may be `_`
  CagPattern *pattern; // NULL: a name
  CagExpr *fallback;   // the default; NULL: none, as for a pattern
} CagParameter;

// The body of a lambda or of a definition with parameters.
struct CagFunctionAst {
  const char *name; // of the definition; NULL: a lambda
  CagParameter *parameters;
  size_t parameter_count, required_count;
  CagExpr *body;
  CagSpan span;
  CagFunctionAst *outer; // innermost enclosing function (set by the resolver)
  CagDecl *self;         // BLOCK function definitions: the name for recursive calls; NULL otherwise
};

// What a NAME refers to (set by the resolver).
typedef enum CagBinding {
  CAG_BIND_NONE,
  CAG_BIND_DECL,    // decl
  CAG_BIND_BUILTIN, // index: of the built-in
  CAG_BIND_OUTER    // index: result of CagResolveEnv.find_outer (earlier inputs of the REPL)
} CagBinding;

struct CagExpr {
  CagExprKind kind;
  CagSpan span;
  uint32_t height; // of the tree below, from 1; at most CAG_MAX_HEIGHT, so that traversals may
                   // recurse
  union {
    double number;
    struct {
      const char *bytes;
      size_t length;
    } text;
    struct {
      const char *id;
      CagBinding binding;
      CagDecl *decl;
      size_t index;
    } name;
    struct {
      CagExpr **items;
      size_t count;
    } list;
    struct {
      CagClause *clauses;
      size_t count;
      CagExpr *body;
    } comprehension;
    struct {
      CagField *fields;
      size_t count;
    } record;
    struct {
      CagStatement **statements;
      size_t count;
      CagExpr *value;
      bool damaged; // a part of the value could not be read
    } block;
    CagFunctionAst *function;
    struct {
      CagExpr *condition, *then, *otherwise;
    } branch;
    struct {
      CagExpr *operand;
    } unary;
    struct {
      CagBinaryOp op;
      CagSpan op_span;
      CagExpr *left, *right;
    } binary;
    struct {
      CagExpr *low, *high, *step;
      bool open;
    } range; // step NULL: none; open: ..<
    struct {
      CagExpr *callee;
      CagArgument *arguments;
      size_t count;
    } call;
    struct {
      CagExpr *object;
      const char *name;
      CagSpan name_span;
    } member;
  } as;
};

typedef enum CagStatementKind {
  CAG_STATEMENT_IMPORT,
  CAG_STATEMENT_PARAM,
  CAG_STATEMENT_DEFINITION,
  CAG_STATEMENT_SHOW,
  CAG_STATEMENT_PRINT,
  CAG_STATEMENT_ASSERT,
  CAG_STATEMENT_EXPRESSION // only in modes of cag_parse that allow it: the REPL and `cag eval`
} CagStatementKind;

typedef struct CagImportName {
  CagDecl *decl;
  const char *name;
} CagImportName;

// The effect of syntax errors on a statement. If a statement is not sound, only the names that it
// defines are used.
typedef enum CagDamage {
  CAG_SOUND,
  CAG_MENDED, // the probable meaning was used
  CAG_DAMAGED // parts could not be read and became ERROR expressions
} CagDamage;

struct CagStatement {
  CagStatementKind kind;
  CagDamage damage; // in a block: SOUND or DAMAGED
  CagSpan span;
  const char *doc;
  union {
    struct {
      const char *path; // dotted name ("std.materials") or the text
      bool is_text;
      CagSpan path_span;
      CagDecl *decl;     // binds the module; NULL with `: a, b` and no `as`
      const char *alias; // the name after `as`; NULL: none
      CagImportName *names;
      size_t name_count;
      size_t module; // index of the imported module, set by the loader
    } import;
    struct {
      CagDecl *decl;
      CagExpr *value, *domain;
      const char *label;
    } param; // domain: after `in`; may be NULL
    struct {
      CagDecl *decl;
      CagPattern *pattern; // NULL: a name, or a name with parameters
      CagExpr *value;
    } definition; // with parameters: value is a LAMBDA whose function has a name
    struct {
      CagExpr **items;
      size_t count;
    } list; // SHOW, PRINT
    struct {
      CagExpr *condition, *message;
    } assertion; // message may be NULL
    CagExpr *expression;
  } as;
};

// The location of a comment, for the formatter. `doc`: it starts with ///.
typedef struct CagComment {
  CagSpan span;
  bool doc, block;
} CagComment;

typedef struct CagModuleAst {
  CagArena arena;
  const CagSource *source;
  CagStatement **statements;
  size_t count;
  CagDecl **tops; // definitions and params in the order of the file (set by the parser)
  size_t top_count;
  CagComment *comments;
  size_t comment_count;
  size_t name_count; // number of different names, including reserved words
  // Names that unreadable text may define, possibly with repetitions.
  const char **damaged_names;
  size_t damaged_name_count;
} CagModuleAst;

#endif
