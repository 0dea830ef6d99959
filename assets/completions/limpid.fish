# fish completion for limpid, which itself knows what may come next: see `limpid complete`.
function __limpid_complete
    set -l words (commandline -opc)
    set -l now (commandline -ct)
    set -l before ''
    set -l current $now
    if string match -q -- '--*=*' $now
        set before (string replace -r '=.*' '=' -- $now)
        set current (string replace -r '^[^=]*=' '' -- $now)
    end
    for answer in ($words[1] complete $words[2..-1] "$now" 2>/dev/null)
        if not string match -q -- \t'*' $answer
            string match -q -- "$current*" $answer; and echo $before$answer
            continue
        end
        set -l suffixes (string split ' ' -- (string trim -- $answer))[2..-1]
        for file in $current*
            test -d $file; and echo $before$file/; and continue
            for suffix in $suffixes
                string match -q -- "*$suffix" $file; and echo $before$file
            end
        end
    end
end
complete -c limpid -f -a '(__limpid_complete)'
