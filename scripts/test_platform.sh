#!/usr/bin/env bash
# Runs the tests of this checkout on a bare Debian of another release, in a folder of its own: what
# test.sh installs there, nothing else does. As root.
#
# usage: scripts/test_platform.sh [RELEASE] [COMMAND...]     bullseye (Debian 11) by default, and
#                                                            scripts/test.sh
#
# The folder ~/.cache/self_awareness/RELEASE is made by debootstrap, and used again. A COMMAND is run
# in the copy of the checkout, such as: bash -c 'source scripts/prepare.sh; install_packages; build'

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

release=${1:-bullseye}
command=("${@:2}")
[ $# -ge 2 ] || command=(scripts/test.sh)
folder=${XDG_CACHE_HOME:-$HOME/.cache}/self_awareness/$release

install_apt debootstrap
if [ ! -e "$folder/complete" ]; then
  say "Debian $release in $folder"
  rm -rf "$folder"
  mkdir -p "$folder"
  debootstrap --variant=minbase "$release" "$folder" > "$folder.log"
  touch "$folder/complete"
fi

# Only what belongs to the checkout goes along, so that nothing of it is changed.
rm -rf "$folder/root/self_awareness"
mkdir -p "$folder/root/self_awareness"
git -C "$checkout" ls-files --cached --others --exclude-standard -z |
  tar --create --directory "$checkout" --null --files-from - |
  tar --extract --directory "$folder/root/self_awareness"
cp /etc/hosts /etc/resolv.conf "$folder/etc/"

say "$release: ${command[*]}"
# Mounts and processes of its own, which are gone when it ends, however it does.
exec unshare --mount --pid --fork --kill-child bash -c '
  set -e
  mount --rbind --make-rslave /dev "$1/dev"
  mount -t proc proc "$1/proc"
  cd "$1"
  exec chroot "$1" /usr/bin/env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin \
    bash -c "cd /root/self_awareness && exec \"\$@\"" - "${@:2}"
' - "$folder" "${command[@]}"
