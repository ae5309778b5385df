# Completion of carom's commands, options and files in bash. Commands and options are asked of the program itself, so that they
# are always its own.
_carom() {
    local program=${COMP_WORDS[0]} current=${COMP_WORDS[COMP_CWORD]}
    COMPREPLY=()
    if [ "$COMP_CWORD" -eq 1 ] && [[ $current != -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$("$program" --help 2>/dev/null |
            sed -n '/^Subcommands:/,/^[^ ]/ s/^  \([a-z]\{2,\}\) .*/\1/p')" -- "$current")
    elif [[ $current == -* ]]; then
        local command=()
        [ "$COMP_CWORD" -gt 1 ] && command=("${COMP_WORDS[1]}")
        mapfile -t COMPREPLY < <(compgen -W "$("$program" "${command[@]}" --help 2>/dev/null |
            sed -n 's/^  \(-.*\)/\1/p' | grep -oE -- '--[a-z][a-z-]*' | sort -u)" -- "$current")
    else
        mapfile -t COMPREPLY < <(compgen -f -- "$current")
        compopt -o filenames 2>/dev/null || true  # outside of a completion, in a test
    fi
}
complete -F _carom carom
