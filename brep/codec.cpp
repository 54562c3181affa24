#include "brep/codec.hpp"

#include <cmath>
#include <cstring>

namespace brep {

const char *Reader::take(size_t size) {
  if (static_cast<size_t>(end - at) < size)
    throw Failure{CAG_BREP_FAIL_INPUT, "the message is too short"};
  const char *taken = at;
  at += size;
  return taken;
}

uint32_t Reader::u32() {
  uint32_t value;
  std::memcpy(&value, take(sizeof value), sizeof value);
  return value;
}

double Reader::f64() {
  double value;
  std::memcpy(&value, take(sizeof value), sizeof value);
  if (!std::isfinite(value))
    throw Failure{CAG_BREP_FAIL_INPUT, "the message has a number that is not finite"};
  return value;
}

gp_Pnt Reader::point() {
  const double x = f64(), y = f64(), z = f64();
  return gp_Pnt(x, y, z);
}

gp_Vec Reader::vector() { return gp_Vec(point().XYZ()); }

std::string Reader::text() {
  const uint32_t size = count(1);
  return std::string(take(size), size);
}

uint32_t Reader::count(size_t least) {
  const uint32_t n = u32();
  if (n > static_cast<size_t>(end - at) / least)
    throw Failure{CAG_BREP_FAIL_INPUT,
                  "the message is too short for a count of " + std::to_string(n)};
  return n;
}

void Reader::finish() const {
  if (at != end)
    throw Failure{CAG_BREP_FAIL_INPUT,
                  "the message has " + std::to_string(end - at) + " bytes too many"};
}

void Writer::u32(uint32_t value) {
  bytes.append(reinterpret_cast<const char *>(&value), sizeof value);
}

void Writer::f64(double value) {
  bytes.append(reinterpret_cast<const char *>(&value), sizeof value);
}

void Writer::xyz(const gp_XYZ &value) {
  f64(value.X());
  f64(value.Y());
  f64(value.Z());
}

void Writer::text(const std::string &value) {
  // Lengths have 32 bits.
  if (value.size() >= UINT32_MAX)
    throw Failure{CAG_BREP_FAIL_METHOD, "the result is larger than a message can be"};
  u32(static_cast<uint32_t>(value.size()));
  bytes += value;
}

} // namespace brep
