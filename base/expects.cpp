#include "base/expects.h"

#include <cstdio>
#include <cstdlib>

namespace venato::detail {
void contract_failed(const char* kind, const char* condition, const char* file, int line) {
  std::fprintf(stderr, "venato: %s failed: %s\n  at %s:%d\n  this is a fault of the program, not of your input: please report it with this text\n",
               kind, condition, file, line);
  std::fflush(stderr);
  std::abort();
}
}  // namespace venato::detail
