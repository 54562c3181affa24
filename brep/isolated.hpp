// Work in a process of its own: the kernel can crash, or not come to an end.

#ifndef CAG_BREP_ISOLATED_HPP
#define CAG_BREP_ISOLATED_HPP

#include <functional>
#include <string>

namespace brep {

// Does the work in a child process and returns its result in `out`. Returns false, with the reason in
// `why`, if the child crashes, takes longer than `seconds` (0: no limit), or if the pipe `answers`, which
// the result is meant for, has lost its reader (-1: none). The child ends with this process.
bool run_isolated(const std::function<std::string()> &work, double seconds, int answers,
                  std::string &out, std::string &why);

} // namespace brep

#endif
