# The version as git describes the tree: as version.cpp, and as version.cmake with the time of the
# last commit, for packages. Both are written only when they change.
#   cmake -DSOURCE=DIR -DINTO=DIR -DVERSION=0.2.0 -P version.cmake
cmake_minimum_required(VERSION 3.25)
cmake_path(GET SOURCE PARENT_PATH above)
set(ENV{GIT_CEILING_DIRECTORIES} ${above})  # a repository around an unpacked archive is another one
function(git into)
  execute_process(COMMAND git ${ARGN} WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE out
    OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(failed)
    set(out "")
  endif()
  set(${into} "${out}" PARENT_SCOPE)
endfunction()

set(more "")
git(commit rev-parse --short=7 HEAD)
git(epoch log -1 --format=%ct)
if(commit)
  git(release tag --list v${VERSION})
  if(release)
    git(count rev-list --count v${VERSION}..HEAD)
  else()
    git(count rev-list --count HEAD)
  endif()
  if(NOT count EQUAL 0)
    set(more "+${count}.g${commit}")
  endif()
  git(changes status --porcelain --untracked-files=no)
  if(changes)
    set(more "+${count}.g${commit}.changed")
  endif()
else()
  file(TIMESTAMP ${SOURCE}/CHANGELOG.md epoch "%s" UTC)
endif()

file(CONFIGURE OUTPUT ${INTO}/version.cpp CONTENT
"#include \"app/base/version.h\"\n
const char* limpid::program_version() { return \"${VERSION}${more}\"; }
")
file(CONFIGURE OUTPUT ${INTO}/version.cmake CONTENT
"set(limpid_version ${VERSION}${more})\nset(limpid_epoch ${epoch})\n")
