#!/usr/bin/env bash
# Compares our solver with SciPy's on the same residuals: builds the library of this folder and runs compare.py, to which all
# arguments go (--starts N, --log). PROFILE=dev builds sooner; times are then not those of the program.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
python=${PYTHON:-python3}

command -v "$python" >/dev/null || { echo "missing: $python; install Python 3, or name one by PYTHON=..." >&2; exit 1; }
for module in numpy scipy; do
  "$python" -c "import $module" 2>/dev/null \
    || { echo "missing: $module for $python; install it with: $python -m pip install $module" >&2; exit 1; }
done
command -v cargo >/dev/null || { echo "missing: cargo; install Rust" >&2; exit 1; }

profile=${PROFILE:-release}
export CARGO_TARGET_DIR=${CARGO_TARGET_DIR:-$root/target}
cargo build --quiet --profile "$profile" --manifest-path "$here/Cargo.toml"
folder=$CARGO_TARGET_DIR/$([ "$profile" = dev ] && echo debug || echo "$profile")
for library in "$folder"/libgearloss_scipy.so "$folder"/libgearloss_scipy.dylib "$folder"/gearloss_scipy.dll; do
  [ -f "$library" ] && exec "$python" "$here/compare.py" --library "$library" "$@"
done
echo "missing: the library in $folder, though cargo has built it" >&2
exit 1
