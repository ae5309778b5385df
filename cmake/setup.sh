# Installs what the build needs and is missing, from Debian's packages. Sourced by ./run, ./test and .ci/run.

carom_packages="ca-certificates cmake g++ libbenchmark-dev libboost-dev libcairo2-dev libcli11-dev libeigen3-dev libfmt-dev libgtest-dev
    libgmock-dev libhdf5-dev libtbb-dev libvalijson-dev ninja-build nlohmann-json3-dev pkg-config"

# What `carom view` needs beside them; without them the program is built without its window.
carom_view_packages="libimgui-dev libsdl2-dev"

# carom_install PACKAGE...: installs those that are not there; quiet and quick when all are.
carom_install() {
    missing=""
    for package in "$@"; do
        dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing="$missing $package"
    done
    [ -n "$missing" ] || return 0
    if ! command -v apt-get >/dev/null; then
        echo "error: this is not a Debian system; install by hand the equivalents of:$missing" >&2
        return 1
    fi
    sudo=""
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "error: root or sudo is needed to install:$missing" >&2
            return 1
        fi
        sudo="sudo"
    fi
    echo "installing:$missing" >&2
    # A list that is too old names versions that are gone, so it is made anew.
    $sudo apt-get update -qq &&
        $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
}

# carom_build PRESET [CMAKE-OPTION...]: configures and builds build/PRESET; shows the output only when something fails. Where carom_target is
# set that alone is built, and what it needs.
carom_build() {
    preset=$1
    shift
    mkdir -p build
    log=build/$preset.log
    [ -e "build/$preset/carom" ] && note="" || note=", which takes some minutes the first time; $log shows how far it is"
    echo "building build/$preset$note" >&2
    if ! { cmake --preset "$preset" "$@" && cmake --build --preset "$preset" --target "${carom_target:-all}"; } >"$log" 2>&1; then
        tail -n 60 "$log" >&2
        echo "error: the build failed; its whole output is in $log" >&2
        return 1
    fi
}
