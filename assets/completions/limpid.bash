# bash completion for limpid, which itself knows what may come next: see `limpid complete`.
_limpid() {
  local line=${COMP_LINE:0:COMP_POINT} words current answer word kind suffixes suffix file
  read -ra words <<<"$line"
  [[ $line == *[[:space:]] ]] && words+=("")
  current=${words[-1]}
  [[ $current == --*=* ]] && current=${current#*=}
  COMPREPLY=()
  while IFS= read -r answer; do
    if [[ $answer == $'\t'* ]]; then
      compopt -o filenames 2>/dev/null
      read -r kind suffixes <<<"$answer"
      while IFS= read -r file; do
        [[ -d $file ]] && COMPREPLY+=("$file") && continue
        for suffix in $suffixes; do
          [[ $file == *"$suffix" ]] && COMPREPLY+=("$file")
        done
      done < <(compgen -f -- "$current")
    else
      word=${answer%%$'\t'*}
      [[ $word == "$current"* ]] || continue
      [[ $word == *= ]] && compopt -o nospace 2>/dev/null
      COMPREPLY+=("$word")
    fi
  done < <("${1/#\~/$HOME}" complete "${words[@]:1}" 2>/dev/null)
  # bash takes what stands before an '=' for a word of its own.
  if [[ $current == *=* && $COMP_WORDBREAKS == *=* ]]; then
    word=${current%"${current##*=}"}
    COMPREPLY=("${COMPREPLY[@]#"$word"}")
  fi
}
complete -F _limpid limpid
