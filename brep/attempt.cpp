#include "brep/attempt.hpp"

#include "brep/codec.hpp"
#include "brep/isolated.hpp"
#include "brep/shapes.hpp"

#include <Standard_Failure.hxx>

namespace brep {

std::string failure_bytes(const Failure &failure) {
  Writer out;
  out.u32(failure.reason);
  out.text(failure.what);
  out.u32(failure.edge);
  out.f64(failure.limit);
  return out.bytes;
}

// A result starts with 0, a failure with its reason. Solids that were found valid are sent as such.
static std::string method_bytes(const std::function<Solids()> &method) {
  try {
    const Solids solids = method();
    Writer out;
    out.u32(0);
    out.u32(static_cast<uint32_t>(solids.size()));
    for (const TopoDS_Solid &solid : solids) {
      out.text(write_body(solid));
      out.u32(is_known_valid(solid));
      const Measures measures = measures_of(solid);
      out.f64(measures.volume);
      out.f64(measures.area);
      out.xyz(measures.centroid.XYZ());
    }
    return out.bytes;
  } catch (const Failure &failure) {
    return failure_bytes(failure);
  } catch (const Standard_Failure &failure) {
    const std::string message = failure.GetMessageString();
    return failure_bytes(
        {CAG_BREP_FAIL_METHOD, message.empty() ? failure.DynamicType()->Name() : message});
  } catch (const std::exception &failure) {
    return failure_bytes({CAG_BREP_FAIL_METHOD, failure.what()});
  }
}

bool attempt(const std::function<Solids()> &method, double seconds, Solids &result,
             Failure &failure) {
  std::string bytes, why;
  if (!run_isolated([&] { return method_bytes(method); }, seconds, -1, bytes, why)) {
    failure = {CAG_BREP_FAIL_METHOD, why};
    return false;
  }
  Reader in(bytes.data(), bytes.size());
  const uint32_t reason = in.u32();
  if (reason) {
    failure = {static_cast<CagBrepFailure>(reason), in.text(), in.u32(), in.f64()};
    return false;
  }
  result.clear();
  const uint32_t n = in.u32();
  for (uint32_t i = 0; i < n; ++i) {
    result.push_back(read_body_solid(in));
    if (in.u32()) note_valid(result.back());
    const double volume = in.f64(), area = in.f64();
    note_measures(result.back(), {volume, area, in.point()});
  }
  return true;
}

} // namespace brep
