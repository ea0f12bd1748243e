#include "base/h5/h5_handle_h5.h"

#include <algorithm>

#include "base/error.h"

namespace venato::h5 {

void silence_error_stack() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

void fail(const std::filesystem::path& path, const std::string& doing) {
  std::string reason;
  const auto keep_last = [](unsigned, const H5E_error2_t* entry, void* out) -> herr_t {
    if (entry->desc && *entry->desc) *static_cast<std::string*>(out) = entry->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep_last, &reason);  // downward ends at the deepest call, which knows why
  H5Eclear2(H5E_DEFAULT);
  throw WorkError(path.string() + ": cannot " + doing + (reason.empty() ? "" : ": " + reason));
}

Handle checked(hid_t id, Handle::Close close, const std::filesystem::path& path, const std::string& doing) {
  if (id < 0) fail(path, doing);
  return {id, close};
}

void check(herr_t status, const std::filesystem::path& path, const std::string& doing) {
  if (status < 0) fail(path, doing);
}

Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.get(), std::max<std::size_t>(1, length));
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}
}  // namespace venato::h5
