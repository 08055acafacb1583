#!/bin/sh
# Installs gearloss for the user who runs it: program, manual pages, completions and examples.
#
#   sh install.sh [--dir DIR] [--version VERSION] [--from PLACE] [--target TARGET]
#
# A release fills in its address and its version; the copy in the sources has neither and needs --from.
set -eu

repository=""
version=""

usage() {
  cat <<'END'
Installs gearloss for the current user.

  --dir DIR          folder of the program [default: ~/.local/bin]. If it is called bin, manual pages, completions and
                     examples are installed into share beside it
  --version VERSION  version to install [default: that of this installer]
  --from PLACE       where the archives are: an address or a folder [default: the release of that version]
  --target TARGET    x86_64-unknown-linux-gnu, x86_64-unknown-linux-musl, aarch64-unknown-linux-gnu,
                     aarch64-unknown-linux-musl, x86_64-apple-darwin or aarch64-apple-darwin [default: this computer]
END
}

fail() {
  echo "install.sh: $1" >&2
  exit 1
}

from=""
dir=""
target=""
while [ $# -gt 0 ]; do
  case $1 in
    -h | --help) usage; exit 0 ;;
    --dir | --version | --from | --target) [ $# -ge 2 ] || fail "$1 needs a value" ;;
    *) usage >&2; fail "there is no option $1" ;;
  esac
  case $1 in
    --dir) dir=$2 ;;
    --version) version=${2#v} ;;
    --from) from=$2 ;;
    --target) target=$2 ;;
  esac
  shift 2
done
if [ -z "$dir" ]; then
  [ -n "${HOME:-}" ] || fail "HOME is not set: state the folder with --dir"
  dir=$HOME/.local/bin
fi

# The program for the GNU C library needs version 2.28 of it; the one with musl runs on every Linux, but contains no library for FMUs.
libc() {
  found=$(getconf GNU_LIBC_VERSION 2>/dev/null) || { echo musl; return; }
  found=${found#glibc }
  major=${found%%.*}
  minor=${found#*.}
  minor=${minor%%.*}
  if [ "$major" -gt 2 ] || { [ "$major" -eq 2 ] && [ "$minor" -ge 28 ]; }; then echo gnu; else echo musl; fi
}

if [ -z "$target" ]; then
  system=$(uname -s)
  machine=$(uname -m)
  # A shell that Rosetta translates says x86_64 on a processor of Apple.
  if [ "$system" = Darwin ] && [ "$(sysctl -n sysctl.proc_translated 2>/dev/null || true)" = 1 ]; then machine=arm64; fi
  case $machine in
    x86_64 | amd64) machine=x86_64 ;;
    aarch64 | arm64) machine=aarch64 ;;
    *) fail "there is no program for $system on $machine: build it with \`cargo install gearloss\`" ;;
  esac
  case $system in
    Linux) target=$machine-unknown-linux-$(libc) ;;
    Darwin) target=$machine-apple-darwin ;;
    MINGW* | MSYS* | CYGWIN*) fail "on Windows, unpack the archive x86_64-pc-windows-msvc.zip of the release" ;;
    *) fail "there is no program for $system: build it with \`cargo install gearloss\`" ;;
  esac
fi

case $from in
  file://*) from=${from#file://} ;;
esac
case $from in
  "")
    if [ -z "$repository" ] || [ -z "$version" ]; then
      fail "this copy belongs to no release: state the folder or the address of the archives with --from"
    fi
    from=$repository/releases/download/v$version
    ;;
  http://* | https://*) ;;
  *)
    [ -d "$from" ] || fail "there is no folder $from"
    if [ -z "$version" ]; then
      set -- "$from"/gearloss-*-"$target".tar.gz
      [ -e "$1" ] || fail "there is no archive for $target in $from"
      [ $# -eq 1 ] || fail "there are several archives for $target in $from: choose one with --version"
      version=${1#"$from"/gearloss-}
      version=${version%-"$target".tar.gz}
    fi
    ;;
esac
[ -n "$version" ] || fail "state the version with --version"

name=gearloss-$version-$target
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM

fetch() {
  case $from in
    http://* | https://*)
      if command -v curl >/dev/null; then
        curl --fail --silent --show-error --location --output "$work/$1" "$from/$1"
      elif command -v wget >/dev/null; then
        wget -q -O "$work/$1" "$from/$1"
      else
        fail "neither curl nor wget is installed"
      fi
      ;;
    *) cp "$from/$1" "$work/$1" ;;
  esac || fail "$from has no $1"
}

digest() {
  if command -v sha256sum >/dev/null; then
    sha256sum "$1"
  elif command -v shasum >/dev/null; then
    shasum -a 256 "$1"
  elif command -v openssl >/dev/null; then
    openssl dgst -sha256 -r "$1"
  else
    fail "nothing can compute a checksum: sha256sum, shasum and openssl are missing"
  fi | cut -d ' ' -f 1
}

fetch "$name.tar.gz"
fetch "$name.tar.gz.sha256"
expected=$(cut -d ' ' -f 1 "$work/$name.tar.gz.sha256")
found=$(digest "$work/$name.tar.gz")
if [ -z "$expected" ] || [ "$expected" != "$found" ]; then
  fail "the checksum of $name.tar.gz is wrong: nothing is installed"
fi

(cd "$work" && tar -xzf "$name.tar.gz")
unpacked=$work/$name
"$unpacked/gearloss" --version >/dev/null || fail "the program for $target does not run here: choose another with --target"
mkdir -p "$dir"
# Renamed at the end, so that a program that runs is not written into.
cp "$unpacked/gearloss" "$dir/.gearloss.new"
chmod 755 "$dir/.gearloss.new"
mv -f "$dir/.gearloss.new" "$dir/gearloss"
echo "$("$dir/gearloss" --version) is installed: $dir/gearloss"

if [ "$(basename "$dir")" = bin ]; then
  share=$(cd "$dir/.." && pwd)/share
  place() {
    mkdir -p "$(dirname "$share/$2")"
    cp "$unpacked/$1" "$share/$2"
  }
  for page in "$unpacked"/man/*.1; do
    place "man/$(basename "$page")" "man/man1/$(basename "$page")"
  done
  place completions/gearloss.bash bash-completion/completions/gearloss
  place completions/gearloss.zsh zsh/site-functions/_gearloss
  place completions/gearloss.fish fish/vendor_completions.d/gearloss.fish
  mkdir -p "$share/gearloss"
  cp -R "$unpacked/examples" "$share/gearloss"
  echo "The first report: cp -r $share/gearloss/examples/two-speed-ev . && gearloss run two-speed-ev/study.yaml"
fi
case :$PATH: in
  *:"$dir":*) ;;
  *) echo "Add $dir to your path: export PATH=\"$dir:\$PATH\"" ;;
esac
