# Sourced by ./run and ./test: makes .venv (and, for the tests, the independent readers) inside the checkout.
# Does nothing when nothing has changed since the last time.

set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf '%s\n' "$*" >&2; }

# Debian packages that are missing are installed when we may; otherwise they are reported. Where `asks` is set and
# someone is at the terminal, they are asked before.
need_packages() {
    command -v dpkg-query >/dev/null || return 0
    local missing=() package
    for package in "$@"; do
        [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
    done
    [ ${#missing[@]} -eq 0 ] && return 0
    if [ "$(id -u)" -ne 0 ]; then
        say "Missing Debian packages; please run: sudo apt-get install ${missing[*]}"
        return 0
    fi
    if [ -n "${asks:-}" ] && [ -t 0 ] && [ -t 2 ]; then
        local answer=
        read -r -p "Install the Debian packages ${missing[*]}? [Y/n] " answer || answer=n
        # Anything but an empty answer or a yes declines.
        case $answer in "" | [yY] | [yY][eE][sS] | はい) ;; *) return 0 ;; esac
    fi
    say "Installing ${missing[*]} ..."
    apt-get update -qq >&2
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# What Qt's wheels take from a Debian system: a display, OpenGL, fonts; and PulseAudio's library, for the sound.
qt_packages=(
    libdbus-1-3 libegl1 libfontconfig1 libgl1 libgl1-mesa-dri libglib2.0-0 libpulse0 libx11-xcb1 libxcb-cursor0 libxcb-icccm4
    libxcb-image0 libxcb-keysyms1 libxcb-randr0 libxcb-render-util0 libxcb-shape0 libxcb-sync1 libxcb-xfixes0 libxcb-xkb1
    libxext6 libxkbcommon-x11-0 libxkbcommon0 libxrandr2 libxrender1
)

# What rtmidi's wheel takes from Linux; Debian gave it another name after 12.
need_alsa() {
    [ "$(uname)" = Linux ] || return 0
    [[ $(PATH=$PATH:/sbin ldconfig -p 2>/dev/null) != *libasound.so.2* ]] || return 0
    case $(. /etc/os-release && printf '%s' "$ID${VERSION_ID:-}") in
        debian12) need_packages libasound2 ;;
        *) need_packages libasound2t64 ;;
    esac
}

usable_python() {
    local candidate
    for candidate in python3.11 python3 python3.12 python3.13 python3.14; do
        if "$candidate" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
            printf '%s' "$candidate"
            return 0
        fi
    done
    return 1
}

# A Python on which MIDI devices are reached by rtmidi2: newer than .venv's, or at least one for which it has a wheel.
newer_python() {
    local candidate
    for candidate in python3.14 python3.13 "${PYENV_ROOT:-$HOME/.pyenv}"/versions/3.1[34]*/bin/python python3.12; do
        if "$candidate" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 12))' 2>/dev/null; then
            printf '%s' "$candidate"
            return 0
        fi
    done
    return 1
}

# environment FOLDER STAMP PIP-ARGUMENTS...: a virtual environment that holds exactly what was asked for.
# `use_python`, where it is set, names the Python.
environment() {
    local folder=$1 stamp=$2 python key
    shift 2
    python=${use_python:-$(usable_python)} || {
        need_packages python3 python3-venv
        python=$(usable_python) || { say "Suisou needs Python 3.11 or newer with venv."; exit 1; }
    }
    key=$({ cat pyproject.toml; printf '%s ' "$@"; "$python" -VV; pwd; } | cksum)
    [ -x "$folder/bin/python" ] && [ "$(cat "$folder/$stamp" 2>/dev/null)" = "$key" ] && return 0
    say "Setting up $folder ..."
    [ -x "$folder/bin/python" ] || "$python" -m venv "$folder"
    "$folder/bin/python" -m pip install --quiet --disable-pip-version-check "$@" >&2
    printf '%s' "$key" > "$folder/$stamp"
}
