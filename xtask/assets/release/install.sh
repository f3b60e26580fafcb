#!/bin/sh
# Installs stribeck {{version}} for this user from the archive beside this file. STRIBECK_TO names the folder of the program, by
# default ~/.local/bin; STRIBECK_FROM where the archive is, a folder or an address.
set -eu

from="${STRIBECK_FROM:-$(dirname "$0")}"
to="${STRIBECK_TO:-$HOME/.local/bin}"
case "$(uname -s) $(uname -m)" in
"Linux x86_64") target=x86_64-unknown-linux-gnu ;;
"Linux aarch64") target=aarch64-unknown-linux-gnu ;;
"Darwin x86_64") target=x86_64-apple-darwin ;;
"Darwin arm64") target=aarch64-apple-darwin ;;
*)
    echo "There is no program for $(uname -s) on $(uname -m): cargo install --profile dist stribeck builds it." >&2
    exit 1
    ;;
esac
name="stribeck-{{version}}-$target"
sum="$(grep "  $name.tar.gz\$" <<'SUMS' || true
{{sums}}
SUMS
)"
[ -n "$sum" ] || {
    echo "This release has no program for $target: cargo install --profile dist stribeck builds it." >&2
    exit 1
}
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
case "$from" in
*://*) curl -fsSL -o "$work/$name.tar.gz" "$from/$name.tar.gz" ;;
*)
    [ -f "$from/$name.tar.gz" ] || {
        echo "There is no $name.tar.gz in $from: STRIBECK_FROM names the folder or the address that has it." >&2
        exit 1
    }
    cp "$from/$name.tar.gz" "$work"
    ;;
esac
case "$to" in
/*) ;;
*) to="$PWD/$to" ;;
esac
cd "$work"
if command -v sha256sum >/dev/null; then
    echo "$sum" | sha256sum -c - >/dev/null
else
    echo "$sum" | shasum -a 256 -c - >/dev/null
fi
tar -xzf "$name.tar.gz"
mkdir -p "$to"
mv "$name/stribeck" "$to/stribeck"
echo "$to/stribeck is there: stribeck demo shows what it does."
case ":$PATH:" in
*":$to:"*) ;;
*) echo "Add $to to PATH." ;;
esac
