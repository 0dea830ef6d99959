# What has to be packed while it is installed, and what belongs to the system alone.
# SOURCE, BUILD: the folders.
include(${SOURCE}/app/install_changes.cmake)

# By way of the build folder: what is copied from there gets the permissions that all have.
file(CREATE_LINK ../libexec/limpid/limpid ${made}/limpid SYMBOLIC)
file(INSTALL ${made}/limpid DESTINATION ${CMAKE_INSTALL_PREFIX}/bin)

# The Python package goes where Python looks: below /usr where Debian's does, elsewhere into a folder
# of that prefix which the python3 of whoever installs has in its path, as ~/.local has one.
set(modules lib/python3/dist-packages)
if(NOT CMAKE_INSTALL_PREFIX STREQUAL /usr)
  find_program(limpid_python python3)
  set(folder)
  if(limpid_python)
    execute_process(COMMAND ${limpid_python} -c "
import os, site, sys
prefix = os.path.realpath(sys.argv[1])
folders = [os.path.realpath(each) for each in [*site.getsitepackages(), site.getusersitepackages()]]
print(next((os.path.relpath(each, prefix) for each in folders if each.startswith(prefix + os.sep)), ''))"
      ${CMAKE_INSTALL_PREFIX} OUTPUT_VARIABLE folder OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  endif()
  if(folder)
    set(modules ${folder})
  else()
    message("Python looks nowhere below ${CMAKE_INSTALL_PREFIX}. For `import limpid`: "
      "export PYTHONPATH=${CMAKE_INSTALL_PREFIX}/${modules}")
  endif()
endif()
file(INSTALL ${SOURCE}/assets/python/limpid DESTINATION ${CMAKE_INSTALL_PREFIX}/${modules}
  PATTERN "__pycache__" EXCLUDE)
include(${BUILD}/python_module.cmake)
if(python_module)
  cmake_path(GET python_module FILENAME name)
  set(installed $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/${modules}/limpid/${name})
  file(INSTALL ${python_module} DESTINATION ${CMAKE_INSTALL_PREFIX}/${modules}/limpid)
  file(RPATH_REMOVE FILE ${installed})  # of the build
  if(CMAKE_INSTALL_DO_STRIP)
    execute_process(COMMAND strip --strip-unneeded ${installed} COMMAND_ERROR_IS_FATAL ANY)
  endif()
endif()

file(GLOB pages ${made}/man/man1/*.1)
foreach(page ${pages})
  cmake_path(GET page FILENAME name)
  pack(${page} man/man1 ${name})
endforeach()
pack_changes(limpid)

if(CMAKE_INSTALL_PREFIX STREQUAL /usr)
  file(INSTALL ${SOURCE}/assets/udev/70-limpid.rules DESTINATION /usr/lib/udev/rules.d)
  file(INSTALL ${SOURCE}/assets/desktop/limits.conf DESTINATION /etc/security/limits.d
    RENAME limpid.conf)
endif()
