// The fields of messages (interp/kernel/protocol.h), to and from bytes.
//
// A reader checks all that it reads: a message that is too short, a count that cannot be true for
// its length, or a number that is not finite is a Failure.

#ifndef CAG_BREP_CODEC_HPP
#define CAG_BREP_CODEC_HPP

#include "brep/failure.hpp"
#include "brep/handle.hpp"

#include <cstddef>
#include <cstdint>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>
#include <string>

namespace brep {

class Reader {
public:
  Reader(const char *bytes, size_t size) : at(bytes), end(bytes + size) {}

  uint32_t u32();
  double f64();
  gp_Pnt point();
  gp_Vec vector();
  std::string text();
  // Reads a number of items that take at least `least` bytes each.
  uint32_t count(size_t least);
  // Fails unless the message ends here.
  void finish() const;

private:
  const char *take(size_t size);

  const char *at, *end;
};

class Writer {
public:
  void u32(uint32_t value);
  void f64(double value);
  void xyz(const gp_XYZ &value);
  void text(const std::string &value);

  std::string bytes;
};

} // namespace brep

#endif
