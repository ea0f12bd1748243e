#include "base/version.h"

#ifndef VENATO_VERSION  // the build defines both for this file alone; editors' single-file checks do not
#define VENATO_VERSION "0"
#endif
#ifndef VENATO_GIT
#define VENATO_GIT ""
#endif

namespace venato {
std::string version_string() {
  const std::string git = VENATO_GIT;
  return git.empty() ? VENATO_VERSION : VENATO_VERSION " (" + git + ")";
}
}  // namespace venato
