# scripts/lib/arm64_chroot.bash - a Debian that compiles for arm64 and runs the result by qemu-user. Sourced after
# debian_chroot.bash.

# arm64_chroot SUITE CONTROL: prints the folder of one that has in /arm64 what CONTROL, a debian/control, asks for. Made once
# for each CONTROL. What is in /arm64 is unpacked, not installed: scripts of packages would be arm64's own.
arm64_chroot() {
  local folder=$chroot_cache/$1-arm64
  if [[ ! -d $folder ]]; then
    copy_chroot "$(bare_chroot "$1")" "$folder.new"
    in_chroot "$folder.new" apt-get -q update >/dev/null
    install_in "$folder.new" crossbuild-essential-arm64 cmake ninja-build pkg-config gettext qemu-user-static dpkg-dev \
      >"$folder.log" 2>&1 || { tail -n 5 "$folder.log" >&2; return 1; }
    mv "$folder.new" "$folder"
  fi
  if ! cmp -s "$2" "$folder/arm64/control"; then
    rm -rf "$folder/arm64"
    mkdir -p "$folder"/arm64/{debian,usr/{bin,sbin,lib},apt/lists/partial,apt/archives/partial}
    cp "$2" "$folder/arm64/debian/control"
    in_chroot "$folder" /bin/bash -c "$unpack_arm64" >"$folder.log" 2>&1 || { tail -n 5 "$folder.log" >&2; return 1; }
    mv "$folder/arm64/debian/control" "$folder/arm64/control"
  fi
  echo "$folder"
}

# An apt that knows of arm64 alone, and of nothing that is installed, so that it fetches everything.
unpack_arm64='
  set -e
  cd /arm64
  for name in bin sbin lib; do ln -s usr/$name $name; done
  touch apt/status
  cat >apt/conf <<END
APT::Architecture "arm64";
APT::Architectures { "arm64"; };
APT::Sandbox::User "root";
Dir::State "/arm64/apt";
Dir::State::status "/arm64/apt/status";
Dir::Cache "/arm64/apt";
END
  export APT_CONFIG=/arm64/apt/conf
  apt-get -q update
  apt-get -q -o Acquire::Retries=3 --download-only -y --no-install-recommends build-dep /arm64
  for package in apt/archives/*.deb; do dpkg-deb --fsys-tarfile "$package" | tar -x --keep-directory-symlink; done
  rm -rf apt
  # Links from the root would lead out of here.
  find usr/lib/aarch64-linux-gnu -maxdepth 1 -lname "/*" | while read -r link; do
    ln -sfn "/arm64$(readlink "$link")" "$link"
  done
'
