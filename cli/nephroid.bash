# Completion of nephroid for bash. Options and settings are asked of the program itself, so
# that this file never lags behind it.

_nephroid_options() {
    "$1" "$2" --help 2>/dev/null | grep -oE -- '--[a-z-]+' | sort -u
}

_nephroid() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]}
    local program=${COMP_WORDS[0]} command=${COMP_WORDS[1]}
    COMPREPLY=()
    if [ "$COMP_CWORD" = 1 ]; then
        mapfile -t COMPREPLY < <(
            compgen -W 'render photons info convert compare image settings features bsdf view --help --version' -- "$word")
        return
    fi
    case $before in
    -s | --set)
        compopt -o nospace
        mapfile -t COMPREPLY < <(compgen -S = -W "$("$program" settings --markdown |
            sed -n 's/^| `\([^`]*\)`.*/\1/p')" -- "$word")
        return
        ;;
    --preset)
        mapfile -t COMPREPLY < <(compgen -W "$("$program" settings --presets |
            sed 's/ .*//')" -- "$word")
        return
        ;;
    --class)
        mapfile -t COMPREPLY < <(compgen -W 'direct indirect caustic' -- "$word")
        return
        ;;
    --metric)
        mapfile -t COMPREPLY < <(compgen -W 'rmse relmse psnr flip' -- "$word")
        return
        ;;
    --integrator)
        mapfile -t COMPREPLY < <(compgen -W "$("$program" settings |
            sed -n 's/^integrator .*(\(.*\))$/\1/p' | tr -d '|')" -- "$word")
        return
        ;;
    esac
    case $word in
    -*) mapfile -t COMPREPLY < <(
        compgen -W "$(_nephroid_options "$program" "$command")" -- "$word") ;;
    *) mapfile -t COMPREPLY < <(compgen -f -- "$word") ;;
    esac
}

complete -o filenames -F _nephroid nephroid
