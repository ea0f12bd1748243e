# shellcheck shell=bash
# shellcheck disable=SC2034,SC2154  # the callers read the package lists and set root
# Shared by ./run and ./check (source it): Debian packages, configuring, building. Needs $root, the repository's folder.

say() { printf 'venato: %s\n' "$*" >&2; }
die() {
  say "$*"
  exit 1
}

# One package per line: name, then why it is needed. All are in Debian 12.
build_packages='
g++                      compiles the program
cmake                    configures the build
ninja-build              runs the build
ccache                   makes the next build short
git                      writes the commit into the version and run.json
ca-certificates          lets apt and git use https mirrors
pkgconf                  CMake finds HDF5 with it
libeigen3-dev            small vectors and linear algebra
nlohmann-json3-dev       reads configs
libspdlog-dev            messages and log
libcli11-dev             command line
libssl-dev               SHA-256 of stored operators and printer files
libhwy-dev               vector code of the contact loop, chosen for the CPU at run time
libhdf5-dev              run data, operators, checkpoints
libopencv-core-dev       images
libopencv-imgproc-dev    image filters and warps
libopencv-imgcodecs-dev  reads and writes PNG and JPEG
libopencv-video-dev      registration by optical flow and ECC
libopencv-features2d-dev registration by features
libopencv-calib3d-dev    registration: robust pose
libtiff-dev              N-ink printer files
libdeflate-dev           compresses their strips at twice the rate of zlib
liblcms2-dev             RGB to inks through the ICC profile of the printer
libassimp-dev            hopper and gate meshes (STL, OBJ)
'
check_packages='
libgtest-dev             the tests
libtiff-tools            tests read our TIFF files with a second program (tiffinfo)
imagemagick              tests read our pictures with a second program
libvips-tools            tests read our printer files with a second program (vips)
gdal-bin                 tests read our printer files with a second program (gdal_translate)
ghostscript              tests print the preview with a second program (gs)
hdf5-tools               tests read our HDF5 files with a second program (h5dump)
chromium                 tests open the HTML report in a browser
'

is_installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null || true)" = installed ]; }

# install_missing LIST: says what is missing and why, then installs it; does nothing (no apt, no network) when nothing is.
install_missing() {
  local name why missing=()
  if ! command -v dpkg-query >/dev/null; then
    say "this is not a Debian system (no dpkg-query): install the counterparts of these packages yourself if the build asks for them:"
    while read -r name why; do [ -z "$name" ] || printf '  %-26s %s\n' "$name" "$why" >&2; done <<<"$1"
    return
  fi
  while read -r name why; do
    [ -n "$name" ] || continue
    is_installed "$name" && continue
    [ "${#missing[@]}" -gt 0 ] || say "these Debian packages are missing:"
    printf '  %-26s %s\n' "$name" "$why" >&2
    missing+=("$name")
  done <<<"$1"
  [ "${#missing[@]}" -gt 0 ] || return 0

  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || die "cannot install them: neither root nor sudo. Ask an administrator to run:
  apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
  fi
  say "installing them with apt-get"
  local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300)
  "${apt[@]}" update >&2 || say "apt-get update failed; trying with the package lists that are here"
  "${apt[@]}" install -y --no-install-recommends "${missing[@]}" >&2 || die "apt-get could not install the packages above (its message is above this line)"
}

cores() { nproc; }

# Compile jobs: all cores, but about 1 GiB of memory for each, or the machine swaps.
build_jobs() {
  local jobs memory_kib
  jobs=$(cores)
  memory_kib=$(awk '/^MemAvailable:/ {print $2}' /proc/meminfo 2>/dev/null || true)
  if [ -n "$memory_kib" ] && [ "$((memory_kib / 1048576))" -lt "$jobs" ]; then jobs=$((memory_kib / 1048576)); fi
  [ "$jobs" -ge 1 ] || jobs=1
  echo "$jobs"
}

# A build folder made for another source folder (moved, copied, mounted elsewhere) or by another generator cannot be reused.
drop_foreign_build() {
  local cache=$1/CMakeCache.txt
  [ -f "$cache" ] || return 0
  if grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$cache" && grep -qxF "CMAKE_CACHEFILE_DIR:INTERNAL=$1" "$cache" &&
    grep -qxF "CMAKE_GENERATOR:INTERNAL=Ninja" "$cache"; then
    return 0
  fi
  say "$1 was made for another folder or generator: starting afresh"
  rm -rf -- "$1"
}

# configure_and_build PRESET FOLDER "cmake options" target...
configure_and_build() {
  local preset=$1 folder=$2 log
  local -a options
  read -r -a options <<<"$3"
  shift 3
  drop_foreign_build "$folder"
  mkdir -p "$folder"
  log=$folder/configure.log
  local configure=(cmake --preset "$preset" -B "$folder" "${options[@]}")
  if ! (cd "$root" && "${configure[@]}") >"$log" 2>&1; then
    # Packages that came, went or were upgraded since leave wrong paths in the cache: one clean try tells.
    rm -rf -- "$folder/CMakeCache.txt" "$folder/CMakeFiles"
    (cd "$root" && "${configure[@]}") >"$log" 2>&1 || {
      cat "$log" >&2
      die "CMake could not configure the build (its message is above this line)"
    }
  fi
  say "building with $(build_jobs) jobs in $folder"
  cmake --build "$folder" -j "$(build_jobs)" --target "$@" >&2 || die "the build failed (the compiler's message is above this line)"
}
