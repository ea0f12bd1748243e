#pragma once
#include <string>
namespace venato {
/// "0.1.0 (a1b2c3d)": version and, when built from a git clone, the commit. Goes into run.json and `venato version`.
std::string version_string();
}  // namespace venato
