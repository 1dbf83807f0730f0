#!/usr/bin/env bash
# Runs the tests of this checkout on a bare Debian of another release, in a folder of its own: what
# test.sh installs there, nothing else does. As root.
#
# usage: scripts/test_platform.sh RELEASE [COMMAND...]     the command is scripts/test.sh by default
#
#   trixie, bookworm, bullseye   Debian 13, 12, 11
#   noetic                       Debian 11, made as near to Noetic as packages allow
#                                (scripts/near_noetic.sh)
#
# The folder ~/.cache/self_awareness/RELEASE is made by debootstrap, and used again. A COMMAND is run
# in the copy of the checkout, such as: bash -c 'source scripts/prepare.sh; install_packages; build'
# The recordings in ../shared, or SELF_AWARENESS_SHARED, can be read there, too. Ctrl-C and SIGTERM
# end all that runs there.

release=${1:-}
command=("${@:2}")
[ $# -ge 2 ] || command=(scripts/test.sh)
suite=$release
case $release in
  trixie | bookworm | bullseye) ;;
  noetic)
    suite=bullseye
    command=(scripts/near_noetic.sh "${command[@]}")
    ;;
  *)
    sed -n '2,/^$/s/^# \{0,1\}//p' "$0"
    exit 2
    ;;
esac
if [ "$EUID" -ne 0 ]; then
  echo "test_platform.sh: error: only root may mount and change the root folder: sudo $0 $*" >&2
  exit 1
fi

source "$(dirname "${BASH_SOURCE[0]}")/prepare.sh"

folder=${XDG_CACHE_HOME:-$HOME/.cache}/self_awareness/$release
shared=${SELF_AWARENESS_SHARED:-$checkout/../shared}
apart=  # the process that waits for what runs apart

# apart COMMAND...: with mounts and processes of its own, which are gone when it has ended
apart() {
  # In the background, since only "wait" lets a trap end it at once; with the input of this script.
  unshare --mount --pid --mount-proc --fork --kill-child "$@" <&0 &
  apart=$!
  wait "$apart"
}

# The first of the processes apart takes no signal but SIGKILL, by which all of them end with it;
# unshare ends after them. It may not have begun when this is called.
end_apart() {  # EXIT-CODE
  trap '' INT TERM
  while [ -n "$apart" ] && kill -0 "$apart" 2> /dev/null; do
    xargs --no-run-if-empty kill -KILL < "/proc/$apart/task/$apart/children" 2> /dev/null || true
    sleep 0.1
  done
  exit "$1"
}
trap 'end_apart 130' INT
trap 'end_apart 143' TERM

if [ ! -e "$folder/complete" ]; then
  install_apt debootstrap
  say "Debian $suite in $folder"
  rm -rf "$folder"
  mkdir -p "$folder"
  apart debootstrap --variant=minbase "$suite" "$folder" > "$folder.log" || {
    tail -n 20 "$folder.log" >&2
    exit 1
  }
  touch "$folder/complete"
fi

# Only what belongs to the checkout goes along, so that nothing of it is changed.
rm -rf "$folder/root/self_awareness"
mkdir -p "$folder/root/self_awareness"
git -C "$checkout" ls-files --cached --others --exclude-standard -z |
  tar --create --directory "$checkout" --null --files-from - |
  tar --extract --directory "$folder/root/self_awareness"
cp /etc/hosts /etc/resolv.conf "$folder/etc/"
# Its network may need certificates that this machine trusts, and Debian does not.
certificates=/etc/ssl/certs/ca-certificates.crt
[ ! -e "$certificates" ] || cp "$certificates" "$folder/etc/certificates.crt"
# Without the folder, tests skip what needs it.
[ ! -d "$folder/root/shared" ] || rmdir "$folder/root/shared"
if [ -d "$shared" ]; then
  mkdir "$folder/root/shared"
else
  say "There is no folder $shared: its recordings are not tested"
fi

say "$release: ${command[*]}"
apart bash -c '
  set -e
  mount --rbind --make-rslave /dev "$1/dev"
  mount -t proc proc "$1/proc"
  if [ -d "$1/root/shared" ]; then
    mount --bind "$2" "$1/root/shared"
    mount -o remount,bind,ro "$1/root/shared"
  fi
  cd "$1"
  # Nodes end by SIGINT, which a script lets all in its background ignore.
  exec chroot "$1" /usr/bin/env -i --default-signal=INT,QUIT HOME=/root LANG=C.UTF-8 \
    PATH=/usr/sbin:/usr/bin:/sbin:/bin bash -c "cd /root/self_awareness && exec \"\$@\"" - "${@:3}"
' - "$folder" "$shared" "${command[@]}"
