# Debian packages by what they are for, and their installation. Sourced by the other scripts.

packages_build="g++ cmake ninja-build pkg-config libusb-1.0-0-dev libeigen3-dev libopencv-core-dev
  libopencv-imgproc-dev libopencv-imgcodecs-dev libcli11-dev libfmt-dev nlohmann-json3-dev libboost-dev
  libfreetype-dev libpng-dev libcairo2-dev libarchive-dev libmatio-dev libsqlite3-dev libpugixml-dev libyaml-cpp-dev
  fonts-dejavu-core python3"
packages_test="ccache libgtest-dev libgmock-dev libvalijson-dev zlib1g-dev libumockdev-dev umockdev tshark
  xz-utils python3-numpy python3-jsonschema git"
packages_all="parallel slurmctld slurmd slurm-client chromium libbenchmark-dev clang lld clang-format clang-tidy libclang-rt-14-dev gcc-arm-none-eabi
  libnewlib-arm-none-eabi python3-unicorn
  qemu-system-arm qemu-system-x86 busybox-static kmod lintian libmujoco-dev libsdformat-dev"
packages_package="dpkg-dev file"

# install_packages NAME...: installs those that are missing, as root or through sudo; does nothing when all are there.
install_packages() {
    local missing=() name
    for name in "$@"; do
        dpkg-query -W -f='${Status}' "$name" 2>/dev/null | grep -q 'ok installed' || missing+=("$name")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    local as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || {
            echo "these Debian packages are missing, and there is neither root nor sudo to install them:" >&2
            echo "  apt-get install ${missing[*]}" >&2
            return 1
        }
        as_root=(sudo)
    fi
    echo "installing: ${missing[*]}" >&2
    "${as_root[@]}" apt-get update -qq
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}
