# completion.bash - what may stand on the command lines of the bsdf-* programs
#
# Read by bash-completion from share/bash-completion/completions, or by hand:
#
#     . completion.bash
#     autoload -U +X compinit bashcompinit && compinit && bashcompinit &&
#         . completion.bash                                        # zsh
#
# Options, commands and kinds come from what a program says to --help, checks
# from bsdf-validate --list, models, keys and materials from bsdf-info list: a
# new one needs no word here.

# The argument that an option takes by --help: "FILE" of --json=FILE; nothing
# where it takes none.
_bsdf_argument() {
    "$1" --help 2>/dev/null | awk -v option="$2" '
        /^ +-/ {
            for (i = 1; i <= NF && $i ~ /^-/; i++) {
                split($i, part, "[=,]")
                if (part[1] == option)
                    found = 1
                if (found && $i ~ /=/) {
                    sub(/^[^=]*=/, "", $i)
                    print $i
                    exit
                }
            }
            found = 0
        }'
}

# The first words of the lines below a heading of --help: "Commands:".
_bsdf_under() {
    "$1" --help 2>/dev/null | awk -v heading="$2" '
        $0 == heading { inside = 1; next }
        /^$/ { inside = 0 }
        inside && /^  [^ ]/ { print $1 }' | sort -u
}

# The words of an option that its help lists: "mitsuba, pbrt or cpp".
_bsdf_choices() {
    "$1" --help 2>/dev/null | sed -n "s/^ *$2=[A-Z]*  *//p" |
        tr -d ',' | tr ' ' '\n' | grep -vx or
}

_bsdf_materials() {
    bsdf-info list 2>/dev/null |
        awk '/^[a-z]/ { inside = $1 == "materials" } inside && /^ / {
            print $1
            split($1, part, "/")
            if (!(part[1] in seen))
                print part[1]
            seen[part[1]] = 1 }'
}

# What may follow in "name:key=value,...": names, or keys, or a key's choices.
_bsdf_spec() {
    local word=$1 name=${1%%:*} head key values
    if [[ $word != *:* ]]; then
        bsdf-info list 2>/dev/null |
            awk '/^[a-z]/ { inside = $1 == "models" }
                 inside && /^  [a-z]/ { print $1 }'
        return
    fi
    head=$name:
    [[ $word == *,* ]] && head=${word%,*},
    key=${word#"$head"}
    if [[ $key == *=* ]]; then
        key=${key%%=*}
        values=$(bsdf-info list 2>/dev/null |
            awk -v name="$name:" -v key="$key" '
                /^  [a-z]/ { inside = $1 == name }
                inside && /^    [a-z]/ && $1 == key { $1 = ""; print }')
        case $values in
        *'name or path'*) _bsdf_materials ;;
        *' | '*) tr '|' '\n' <<<"${values%%;*}" | tr -d ' ' ;;
        esac | sed "/./s|^|$head$key=|"
    else
        bsdf-info list 2>/dev/null | awk -v name="$name:" -v head="$head" '
            /^[a-z]/ { inside = 0 }
            /^  [a-z]/ { inside = $1 == name }
            inside && /^    [a-z]/ { print head $1 "=" }'
    fi
}

# What may stand for an option's argument, by its name in --help.
_bsdf_values() {
    case $3 in
    FILE*) compgen -f -- "$4" ;;
    DIR) compgen -d -- "$4" ;;
    CHECK) bsdf-validate --list 2>/dev/null | awk '{ print $1 }' ;;
    METHOD)
        printf '%s\n' fit average fixed:
        [ "$1" != bsdf-info ] || echo all ;;
    FORMAT | HOW) _bsdf_choices "$1" "$2" ;;
    SPEC) _bsdf_spec "$4" ;;
    esac
}

# What may stand as a word by itself: before it are the words from $3 on.
_bsdf_operands() {
    local program=$1 current=$2
    shift 2
    case $program in
    bsdf-info)
        case $1 in
        '') _bsdf_under bsdf-info Commands: ;;
        ior | cite) _bsdf_materials ;;
        eval | sample | albedo)
            if [ $# -eq 1 ]; then
                _bsdf_spec "$current"
            else
                compgen -f -- "$current"
            fi ;;
        esac ;;
    bsdf-plot)
        case $1 in
        '') _bsdf_under bsdf-plot Kinds: ;;
        ior) _bsdf_materials ;;
        report) compgen -f -- "$current" ;;
        *) _bsdf_spec "$current"; compgen -f -- "$current" ;;
        esac ;;
    bsdf-validate) _bsdf_spec "$current"; compgen -f -- "$current" ;;
    *) compgen -f -- "$current" ;;
    esac
}

# The words before the current one; what is no option and no option's argument.
_bsdf() {
    local line=${COMP_LINE:0:$COMP_POINT} program=${COMP_WORDS[0]##*/}
    local current previous word taken='' head reply
    local -a words operands
    # By blanks: bash has cut the words at = and : as well.
    if [ -n "${ZSH_VERSION-}" ]; then
        IFS=$' \t\n' read -r -A words <<<"$line"
    else
        IFS=$' \t\n' read -r -a words <<<"$line"
    fi
    case $line in
    *[[:space:]]) current='' ;;
    *) current=${words[@]: -1}; words=("${words[@]:0:${#words[@]}-1}") ;;
    esac
    previous=${words[@]: -1}
    for word in "${words[@]:1}"; do
        if [ -n "$taken" ]; then
            taken=''
        elif [[ $word == -* ]]; then
            [[ $word == *=* ]] || taken=$(_bsdf_argument "$program" "$word")
        else
            operands+=("$word")
        fi
    done
    if [[ $current == --*=* ]]; then
        head=${current%%=*}
        reply=$(_bsdf_values "$program" "$head" \
            "$(_bsdf_argument "$program" "$head")" "${current#*=}" |
            sed "s|^|$head=|")
    elif [ -n "$taken" ]; then
        reply=$(_bsdf_values "$program" "$previous" "$taken" "$current")
    elif [[ $current == -* ]]; then
        reply=$("$program" --help 2>/dev/null |
            sed -n 's/^  *\(-.,\)\{0,1\} *\(--[a-z-]*=\{0,1\}\).*/\2/p')
    else
        reply=$(_bsdf_operands "$program" "$current" "${operands[@]}")
    fi
    # What bash replaces starts behind the last = or :.
    head=''
    [ -n "${ZSH_VERSION-}" ] || head=${current%"${current##*[=:]}"}
    COMPREPLY=()
    while IFS= read -r word; do
        [[ -n $word && $word == "$current"* ]] && COMPREPLY+=("${word#"$head"}")
    done <<<"$reply"
    # More may follow these.
    [[ ${#COMPREPLY[@]} -eq 1 && ${COMPREPLY[0]} == *[=:/] ]] &&
        compopt -o nospace 2>/dev/null
    return 0
}

complete -o default -F _bsdf bsdf-info bsdf-validate bsdf-plot bsdf-render
