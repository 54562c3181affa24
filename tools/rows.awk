# Makes the C tables of the built-in functions from interp/builtin/*.rows.
#
#     awk -f rows.awk FILE.rows ...                 cag_builtins[], in the order of the files
#     awk -v header=1 -f rows.awk FILE.rows ...     the prototypes of the functions
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
# `functions` states how the names of the functions in C begin; # is a heading of the documentation.
#
# A row begins with its signature (interp/vm/signature.h), which may go on in lines that are indented
# by 4; its last line ends with `-> TYPE`, the type of the result. A name without parentheses is a
# constant, which has no function. Below the signature, indented by 4:
#
# - `first`: the types of the first argument for which the row is called. `sequence` is for list and
#   range, `shape` for all types of shapes, and `movable` for everything that transforms apply to, but
#   lists. Any type by default.
# - `function`: the function in C, if it is not the beginning and the name.
# - The summary, which begins with a capital.
# - The example, indented by 8.

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
    else if (words[i] == "shape") words[i] = "curve, region, surface, solid, mesh, group"
    else if (words[i] == "movable")
      words[i] = "curve, region, surface, solid, mesh, group, camera, light, plane, transform"
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
  else if (own == "") own = prefix name
  if (own != "NULL" && !(own in declared)) {
    declared[own] = 1
    if (header) print "bool " own "(CagCall *call, CagValue *result);"
  }
  if (!header)
    print "    {" quoted(signature) ", " own ", " quoted(result) ", " quoted(summary) ", " \
      quoted(example) ", " (first == "" ? "0" : first) ", " quoted(heading) "},"
  signature = result = summary = example = own = first = ""
}

BEGIN {
  if (!header) print "#include \"interp/builtin/support.h\"\n\nconst CagBuiltin cag_builtins[] = {"
}

FNR == 1 {
  finish_row()
  prefix = heading = ""
}

/^\/\// || /^$/ { next }
/^functions / { prefix = $2; next }
/^# / { finish_row(); heading = substr($0, 3); next }
/^    first: / { first = types(substr($0, 12)); next }
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
  if (!header) print "    {0}};"
}
