# scripts/lib/debian_chroot.bash - a Debian in a folder, for who builds or tries packages. Sourced; needs root and debootstrap.

chroot_cache=${KERF_CHROOTS:-${XDG_CACHE_HOME:-$HOME/.cache}/kerf-chroots}
debian_mirror=${KERF_DEBIAN_MIRROR:-http://deb.debian.org/debian}
# A mirror that was copied long ago says itself that it is not to be trusted any more; set this to something if you do.
debian_old_mirror=${KERF_DEBIAN_OLD_MIRROR:-}
# Folders of ours that are seen in there, FOLDER:WHERE each.
chroot_binds=()
# NAME=VALUE each, of what runs in there.
chroot_environment=()

# need PROGRAM PACKAGE: ends the script where it is missing.
need() {
  command -v "$1" >/dev/null || { echo "$0: $1 is missing: apt install $2" >&2; exit 1; }
}

# bare_chroot SUITE: prints the folder of a Debian of that suite with nothing more than a minimal system has. Made once.
bare_chroot() {
  local folder=$chroot_cache/$1
  if [[ ! -d $folder ]]; then
    mkdir -p "$chroot_cache"
    rm -rf "$folder.new"
    debootstrap --variant=minbase --include=ca-certificates "$1" "$folder.new" "$debian_mirror" >"$folder.log" 2>&1 ||
      { tail -n 5 "$folder.log" >&2; echo "$0: debootstrap failed: $folder.log" >&2; return 1; }
    # Services have no business in it.
    printf '#!/bin/sh\nexit 101\n' >"$folder.new/usr/sbin/policy-rc.d"
    chmod +x "$folder.new/usr/sbin/policy-rc.d"
    [[ ! $debian_old_mirror ]] || echo 'Acquire::Check-Valid-Until "false";' >"$folder.new/etc/apt/apt.conf.d/90old-mirror"
    mv "$folder.new" "$folder"
  fi
  echo "$folder"
}

# copy_chroot FROM TO
copy_chroot() {
  rm -rf "$2"
  cp -a --reflink=auto "$1" "$2"
}

# in_chroot FOLDER COMMAND..: as root within it, with a /proc, a /dev and processes of its own, which end with the command.
in_chroot() {
  local folder=$1
  shift
  cp /etc/resolv.conf "$folder/etc/resolv.conf" 2>/dev/null || true
  CHROOT_BINDS="${chroot_binds[*]}" unshare --mount --pid --fork --kill-child -- /bin/bash -c '
    set -e
    mount --make-rprivate /
    mount -t proc proc "$0/proc"
    mount -t tmpfs tmpfs "$0/dev"
    for node in null zero full random urandom tty; do touch "$0/dev/$node"; mount --bind "/dev/$node" "$0/dev/$node"; done
    ln -s /proc/self/fd "$0/dev/fd"
    mkdir "$0/dev/shm" "$0/dev/pts"
    mount -t tmpfs tmpfs "$0/dev/shm"
    for bind in $CHROOT_BINDS; do mkdir -p "$0${bind#*:}"; mount --bind "${bind%%:*}" "$0${bind#*:}"; done
    exec chroot "$0" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"
  ' "$folder" "${chroot_environment[@]}" "$@"
}

# install_in FOLDER PACKAGE..: without what is only recommended.
install_in() {
  local folder=$1
  shift
  in_chroot "$folder" apt-get -q -o Acquire::Retries=3 install -y --no-install-recommends "$@"
}

# use_ccache SUITE FOLDER: what is compiled in that folder from now on is kept in $chroot_cache/ccache/SUITE, and found there.
use_ccache() {
  mkdir -p "$chroot_cache/ccache/$1"
  chroot_binds+=("$chroot_cache/ccache/$1:/ccache")
  chroot_environment+=("CCACHE_DIR=/ccache")  # debhelper has a HOME of its own for each build
  [[ -x $2/usr/bin/ccache ]] || install_in "$2" ccache >/dev/null
}

# no_ccache FOLDER: what is compiled in that folder is compiled by the compiler. kerf's CMakeLists.txt takes a ccache that it finds.
no_ccache() {
  [[ ! -x $1/usr/bin/ccache ]] || in_chroot "$1" apt-get -q purge -y ccache >/dev/null
}
