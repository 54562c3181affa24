# Generates the C tables of the built-in functions from interp/builtin/*.rows.
#
#     awk -f rows.awk PARAMETER.def ... FILE.rows ...                cag_builtins[], in the order of the files
#     awk -v header=1 -f rows.awk PARAMETER.def ... FILE.rows ...    the prototypes of the functions
#
# PARAMETER.def are interp/vm/parameter_kinds.def and parameter_types.def.
#
# A file has the rows of one family:
#
#     // A comment.
#     functions cag_solids_
#     # Solids
#
#     cone(height: length > 0, radius: length > 0, top: length >= 0 = 0) -> solid
#         first: number
#         function: cag_solids_frustum
#         Returns a cone whose axis is Z.
#             print volume(cone(3, 1)) / pi   // expect: 1
#
# `functions` is the prefix of the names of the C functions; # is a heading of the documentation.
#
# A row starts with its signature (interp/vm/signature.h), which may continue on lines that are
# indented by 4; its last line ends with `-> TYPE`, the type of the result. A name without parentheses
# is a constant, which has no function. Below the signature, indented by 4:
#
# - `first`: the types of the first argument for which the row is called. `sequence` is for list and
#   range, `shape` for all types of shapes, and `movable` for everything that transforms apply to,
#   except lists. Any type by default.
# - `function`: the C function, if its name is not the prefix and the name of the row.
# - `unbound`: the function reads its arguments from the call.
# - The summary, which starts with a capital letter.
# - The example, indented by 8.
#
# The function of a row receives its arguments in a structure with the same name. It has a field for
# each parameter, with the name of the parameter and the C type from parameter_kinds.def:
#
#     struct cag_solids_cone {
#       double height;
#       double radius;
#       double top;
#     };
#     bool cag_solids_cone(CagCall *call, const struct cag_solids_cone *a, CagValue *result);

function fail(text) {
  printf "%s:%d: %s\n", FILENAME, FNR, text > "/dev/stderr"
  failed = 1
  exit 1
}

function quoted(text) {
  gsub(/\\/, "\\\\", text)
  gsub(/"/, "\\\"", text)
  gsub(/\n/, "\\n", text)
  return "\"" text "\""
}

# The bits of CagBuiltin.first.
function types(text,    words, n, i, bits) {
  n = split(text, words, /, */)
  for (i = 1; i <= n; i++) {
    if (words[i] == "sequence") words[i] = "list, range"
    else if (words[i] == "shape") words[i] = "curve, region, surface, solid, mesh, label, group"
    else if (words[i] == "movable")
      words[i] = "curve, region, surface, solid, mesh, label, group, camera, light, plane, transform"
    else if (words[i] !~ /^[a-z]+$/) fail("`" words[i] "` is not the name of a type")
    gsub(/, /, " | UINT64_C(1) << CAG_", words[i])
    bits = bits (i > 1 ? " | " : "") "UINT64_C(1) << CAG_" words[i]
  }
  return toupper_tags(bits)
}

function toupper_tags(text,    out, tag) {
  while (match(text, /CAG_[a-z]+/)) {
    out = out substr(text, 1, RSTART - 1) toupper(substr(text, RSTART, RLENGTH))
    text = substr(text, RSTART + RLENGTH)
  }
  return out text
}

# Returns the kind of the longest known words with which a type starts.
function kind_of(type,    words, best) {
  for (words in kind_of_words)
    if ((type == words || index(type, words " ") == 1) && length(words) > length(best)) best = words
  return best == "" ? "VALUE" : kind_of_words[best]
}

# Returns the kind of the type of a parameter, such as `length > 0` or `"left" or "right"`.
function parameter_kind(type,    i, c, depth, in_text, alternatives, texts, start) {
  type = type " or "
  start = 1
  for (i = 1; i <= length(type); i++) {
    c = substr(type, i, 1)
    if (c == "\"") in_text = !in_text
    if (in_text) continue
    if (c ~ /[[({]/) depth++
    else if (c ~ /[])}]/) depth--
    if (depth > 0 || substr(type, i, 4) != " or ") continue
    alternatives++
    if (substr(type, start, 1) == "\"") texts++
    start = i + 4
  }
  if (texts == alternatives) return "CHOICE"
  return alternatives > 1 ? "VALUE" : kind_of(type)
}

# The index of a text among the alternatives of a type.
function choice_index(type, text,    n, i, parts) {
  n = split(type, parts, / or /)
  for (i = 1; i <= n; i++)
    if (parts[i] == text) return i - 1
  fail("the default " text " is not among the alternatives: " type)
}

# The default of a field in C, where it is simple.
function default_in_c(kind, type, text) {
  if (kind == "BOOL" && text ~ /^(true|false)$/) return text
  if (kind == "CHOICE" && text ~ /^"/) return choice_index(type, text)
  if (kind ~ /^(NUMBER|FINITE|INTEGER)$/ && text ~ /^-?[0-9]+(\.[0-9]+)?$/) return text
  if (text == "none" && kind ~ /^(NUMBER|FINITE|INTEGER|ANGLE|BOOL|CHOICE)$/) return 0
  return ""
}

# The statement that reads argument `i` into its field.
function read_field(i, name, kind, type, fallback,    read) {
  if (kind == "VALUE") return "  a." name " = call->values[" i "];\n"
  read = "cag_bind_field(call, " i ", &a)"
  if (kind in simple_readers && type !~ / (>|in)/)
    read = simple_readers[kind] "(call, " i ", &a." name ")"
  if (fallback == "") return "  if (!" read ") return false;\n"
  if (default_in_c(kind, type, fallback) == "")
    return "  if (!cag_bind_field(call, " i ", &a)) return false;\n"
  return "  if (!cag_given(call, " i ")) a." name " = " default_in_c(kind, type, fallback) ";\n" \
    "  else if (!" read ") return false;\n"
}

# Adds a parameter: its field to `structure`, and the reading of its argument to `reading`.
function add_field(parameter,    name, type, kind, fallback) {
  name = type = parameter
  sub(/:.*/, "", name)
  sub(/^[^:]*: */, "", type)
  if (match(type, / = /)) {
    fallback = substr(type, RSTART + 3)
    type = substr(type, 1, RSTART - 1)
  }
  sub(/^ */, "", name)
  kind = parameter_kind(type)
  if (name ~ /^(break|case|char|const|default|do|double|else|enum|float|for|goto|if|int|long|short|switch|void|while)$/)
    name = name "_"
  structure = structure "  " type_of_kind[kind] (type_of_kind[kind] ~ /\*$/ ? "" : " ") name ";\n"
  reading = reading read_field(field_count++, name, kind, type, fallback)
}

# Adds all parameters but `...`.
function add_fields(signature,    i, c, depth, in_text, start) {
  structure = reading = ""
  field_count = 0
  start = index(signature, "(") + 1
  for (i = start; i < length(signature); i++) {
    c = substr(signature, i, 1)
    if (c == "\"") in_text = !in_text
    if (in_text) continue
    if (c ~ /[[({]/) depth++
    else if (c ~ /[])}]/) depth--
    if (depth > 0 || c != ",") continue
    add_field(substr(signature, start, i - start))
    start = i + 1
  }
  if (start < i && substr(signature, start) !~ /^ *\.\.\.\)$/)
    add_field(substr(signature, start, i - start))
}

# Declares a function, or defines the one that binds its arguments. Returns what the table calls.
function declare(own, signature,    binder) {
  structure = ""
  if (!unbound) add_fields(signature)
  if (own in declared && declared[own] != structure)
    fail("the rows of " own " have different parameters")
  if (structure == "") {
    if (header && !(own in declared)) print "bool " own "(CagCall *call, CagValue *result);"
    declared[own] = structure
    return own
  }
  if (header && !(own in declared)) {
    print "struct " own " {\n" structure "};"
    print "bool " own "(CagCall *call, const struct " own " *a, CagValue *result);"
  }
  declared[own] = structure
  binder = "bind_" ++binders "_" own
  if (!header)
    print "static bool " binder "(CagCall *call, CagValue *result) {\n  struct " own " a;\n" \
      "  CAG_ASSERT(cag_bind_fits(call, sizeof a));\n" reading \
      "  return " own "(call, &a, result);\n}"
  return binder
}

function finish_row(    name) {
  if (signature == "") return
  if (result == "") fail("the signature before this line has no `-> RESULT`")
  if (summary == "") fail(signature " has no summary")
  if (summary !~ /^[A-Z]/) fail("the summary of " signature " does not begin with a capital")
  if (example == "") fail(signature " has no example")
  if (heading == "") fail(signature " is below no heading")
  name = signature
  sub(/\(.*/, "", name)
  if (signature !~ /\(/) own = "NULL"
  else own = declare(own == "" ? prefix name : own, signature)
  rows = rows "    {" quoted(signature) ", " own ", " quoted(result) ", " quoted(summary) ", " \
    quoted(example) ", " (first == "" ? "0" : first) ", " quoted(heading) "},\n"
  unbound = 0
  signature = result = summary = example = own = first = ""
}

BEGIN {
  if (header) print "#ifndef CAG_BUILTIN_FUNCTIONS_H\n#define CAG_BUILTIN_FUNCTIONS_H"
  else print "#include \"base/assert.h\"\n#include \"interp/builtin/support.h\"\n"
  simple_readers["NUMBER"] = "cag_arg_number"
  simple_readers["TEXT"] = "cag_arg_text"
  simple_readers["LIST"] = "cag_arg_list"
  simple_readers["TRANSFORM"] = "cag_arg_transform"
  simple_readers["CURVE"] = "cag_arg_curve"
  simple_readers["SURFACE"] = "cag_arg_surface"
}

/^CAG_PARAMETER_TYPE/ {
  split($0, parts, "\"")
  sub(/^, */, "", parts[3])
  sub(/,.*/, "", parts[3])
  kind_of_words[parts[2]] = parts[3]
  next
}
/^CAG_PARAMETER_KIND/ {
  sub(/^[^(]*\(/, "")
  kind = type = $0
  sub(/,.*/, "", kind)
  sub(/^[^,]*, */, "", type)
  sub(/\).*/, "", type)
  type_of_kind[kind] = type
  next
}

FNR == 1 {
  finish_row()
  prefix = heading = ""
}

/^\/\// || /^$/ { next }
/^functions / { prefix = $2; next }
/^# / { finish_row(); heading = substr($0, 3); next }
/^    first: / { first = types(substr($0, 12)); next }
/^    unbound$/ { unbound = 1; next }
/^    function: / { own = $2; next }
/^        / { example = example (example == "" ? "" : "\n") substr($0, 9); next }
/^    / {
  if (result == "") signature = signature " " substr($0, 5)
  else if (example != "") fail("the summary of " signature " must be before its example")
  else summary = summary (summary == "" ? "" : " ") substr($0, 5)
}
/^[^ ]/ { finish_row(); signature = $0 }
{
  arrow = index(signature, " -> ")
  if (result == "" && arrow) {
    result = substr(signature, arrow + 4)
    signature = substr(signature, 1, arrow - 1)
  }
}

END {
  if (failed) exit 1
  finish_row()
  if (header) print "#endif"
  else print "\nconst CagBuiltin cag_builtins[] = {\n" rows "    {0}};"
}
