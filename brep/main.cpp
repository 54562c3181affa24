// cag-brep: computes the boundaries of solids with Open CASCADE, for cag. It answers the requests
// that it reads from standard input on standard output (interp/kernel/protocol.h).
//
// Each request runs in a child process, so that this program survives crashes of the kernel.

#include "brep/attempt.hpp"
#include "brep/booleans.hpp"
#include "brep/boundary.hpp"
#include "brep/isolated.hpp"
#include "brep/module.hpp"
#include "brep/shapes.hpp"

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Standard_Failure.hxx>
#include <Standard_Version.hxx>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <new>
#include <sys/resource.h>
#include <unistd.h>

namespace brep {

// Longer requests are refused.
static const uint64_t LONGEST_REQUEST = UINT64_C(1) << 32;

struct Header {
  uint64_t type, size;
};

// A message with its header.
static std::string make_message(CagBrepMessage type, const std::string &fields) {
  const Header header = {type, fields.size()};
  return std::string(reinterpret_cast<const char *>(&header), sizeof header) + fields;
}

static std::string make_failure(const Failure &failure) {
  return make_message(CAG_BREP_FAILURE, failure_bytes(failure));
}

static std::string make_result(const std::vector<Part> &parts) {
  if (parts.empty()) throw Failure{CAG_BREP_FAIL_EMPTY, "nothing is left"};
  Writer out;
  out.u32(static_cast<uint32_t>(parts.size()));
  for (const Part &part : parts) {
    out.text(part.name);
    out.u32(part.has_color);
    if (part.has_color)
      for (const double channel : part.color) out.f64(channel);
    if (part.solid.IsNull()) {
      out.u32(static_cast<uint32_t>(part.original));
      for (int i = 1; i <= 3; ++i)
        for (int k = 1; k <= 4; ++k) out.f64(part.placement.Value(i, k));
      continue;
    }
    out.u32(CAG_BREP_NONE);
    const bool changed = complete_edges(part.solid);
    out.text(write_body(part.solid));
    write_boundary(out, part.solid, changed ? measure(part.solid) : measures_of(part.solid));
  }
  return make_message(CAG_BREP_RESULT, out.bytes);
}

// The names of the parts of a split tell those inside of the tool from those outside.
static void answer_here(uint64_t type, Reader &in, std::vector<Part> &parts) {
  if (type != CAG_BREP_EVALUATE && type != CAG_BREP_SPLIT)
    throw Failure{CAG_BREP_FAIL_INPUT, "unknown request " + std::to_string(type)};
  const Solids solids = read_solids(in), tool = type == CAG_BREP_SPLIT ? read_solids(in) : Solids();
  in.finish();
  if (type == CAG_BREP_EVALUATE) return add_valid_parts(parts, solids, "");
  add_valid_parts(parts, combine(BOPAlgo_COMMON, {solids, tool}), "inside");
  add_valid_parts(parts, combine(BOPAlgo_CUT, {solids, tool}), "outside");
}

static std::string answer(uint64_t type, const std::string &fields) {
  Reader in(fields.data(), fields.size());
  std::vector<Part> parts;
  const ModuleAnswer by_module = module_answer(type);
  if (by_module) by_module(type, in, parts);
  else answer_here(type, in, parts);
  return make_result(parts);
}

static bool is_file_request(uint64_t type) {
  return type == CAG_BREP_READ_STEP || type == CAG_BREP_READ_IGES;
}

static std::string answer_or_fail(uint64_t type, const std::string &fields) {
  try {
    return answer(type, fields);
  } catch (const Failure &failure) {
    return make_failure(failure);
  } catch (const Standard_Failure &failure) {
    const std::string message = failure.GetMessageString();
    const std::string name = failure.DynamicType()->Name();
    return make_failure({CAG_BREP_FAIL_METHOD, message.empty() ? name : name + ": " + message});
  } catch (const std::bad_alloc &) {
    return make_failure({CAG_BREP_FAIL_METHOD, "out of memory"});
  } catch (const std::exception &failure) {
    return make_failure({CAG_BREP_FAIL_METHOD, failure.what()});
  }
}

// Loads what a request needs before its process starts, so that later requests have it. A failure
// comes again in that process, which answers with it.
static void load_module(uint64_t type) {
  try {
    module_answer(type);
  } catch (const Failure &) {}
}

static bool write_all(int file, const std::string &bytes) {
  for (size_t done = 0; done < bytes.size();) {
    const ssize_t n = write(file, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<size_t>(n);
  }
  return true;
}

// Reads `size` bytes, or skips them if `bytes` is null. Memory grows with what arrives, not with what
// a header claims.
static bool read_bytes(uint64_t size, std::string *bytes) {
  char block[65536];
  while (size) {
    const ssize_t n =
        read(STDIN_FILENO, block, size < sizeof block ? static_cast<size_t>(size) : sizeof block);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    if (bytes) bytes->append(block, static_cast<size_t>(n));
    size -= static_cast<uint64_t>(n);
  }
  return true;
}

// Solids nest, and the kernel recurses: the stack of the main thread may grow further than usual. 100
// MiB is below the gap that Linux leaves for it.
static void allow_deep_recursion() {
  const rlim_t wanted = 100 << 20;
  rlimit limit;
  if (getrlimit(RLIMIT_STACK, &limit) != 0 ||
      (limit.rlim_cur != RLIM_INFINITY && limit.rlim_cur >= wanted))
    return;
  limit.rlim_cur =
      limit.rlim_max == RLIM_INFINITY || limit.rlim_max > wanted ? wanted : limit.rlim_max;
  setrlimit(RLIMIT_STACK, &limit);
}

// Memory that is freed is kept, because the next request needs it, and is taken in large pieces.
static void keep_memory() {
#ifdef __GLIBC__
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  mallopt(M_MMAP_THRESHOLD, 64 << 20);
  mallopt(M_TOP_PAD, 4 << 20);
#endif
}

static int serve() {
  allow_deep_recursion();
  keep_memory();
  // Standard output becomes standard error, because the kernel prints.
  const int replies = dup(STDOUT_FILENO);
  if (replies < 0 || dup2(STDERR_FILENO, STDOUT_FILENO) < 0) {
    std::perror("cag-brep");
    return 1;
  }
  std::signal(SIGPIPE, SIG_IGN);
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_Printer));

  Writer hello;
  hello.u32(CAG_BREP_PROTOCOL);
  hello.text(CAG_VERSION);
  hello.text("Open CASCADE " OCC_VERSION_COMPLETE);
  if (!write_all(replies, make_message(CAG_BREP_HELLO, hello.bytes))) return 0;
  for (;;) {
    std::string bytes, reply, why;
    if (!read_bytes(sizeof(Header), &bytes)) return 0;
    Header header;
    std::memcpy(&header, bytes.data(), sizeof header);
    if (header.size > LONGEST_REQUEST) {
      if (!read_bytes(header.size, nullptr)) return 0;
      reply = make_failure({CAG_BREP_FAIL_INPUT, "the request is too long"});
    } else {
      bytes.clear();
      if (!read_bytes(header.size, &bytes)) return 0;
      load_module(header.type);
      if (!run_isolated([&] { return answer_or_fail(header.type, bytes); }, 0, replies, reply, why))
        reply = make_failure(is_file_request(header.type)
                                 ? Failure{CAG_BREP_FAIL_FILE, "the file is damaged: " + why}
                                 : Failure{CAG_BREP_FAIL_METHOD, why});
    }
    if (!write_all(replies, reply)) return 0;
  }
}

} // namespace brep

int main(int argc, char **argv) {
  if (argc > 1) {
    const bool version = std::strcmp(argv[1], "--version") == 0;
    std::fprintf(version ? stdout : stderr,
                 version ? "cag-brep %s, Open CASCADE " OCC_VERSION_COMPLETE "\n"
                         : "cag-brep %s serves cag; it is not run by hand\n",
                 CAG_VERSION);
    return version ? 0 : 2;
  }
  return brep::serve();
}
