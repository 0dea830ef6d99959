# What has to be packed while it is installed, and what belongs to the system alone.
# SOURCE, BUILD: the folders.
set(made ${BUILD}/made)

# By way of the build folder: what is copied from there gets the permissions that all have.
file(CREATE_LINK ../libexec/limpid/limpid ${made}/limpid SYMBOLIC)
file(INSTALL ${made}/limpid DESTINATION ${CMAKE_INSTALL_PREFIX}/bin)

# Without the time or the name of the file, so that the same text gives the same bytes.
function(pack file folder name)
  execute_process(COMMAND gzip -9nc ${file} OUTPUT_FILE ${made}/${name}.gz
    COMMAND_ERROR_IS_FATAL ANY)
  file(INSTALL ${made}/${name}.gz DESTINATION ${CMAKE_INSTALL_PREFIX}/share/${folder})
endfunction()

file(GLOB pages ${made}/man/man1/*.1)
foreach(page ${pages})
  cmake_path(GET page FILENAME name)
  pack(${page} man/man1 ${name})
endforeach()
pack(${SOURCE}/CHANGELOG.md doc/limpid changelog)

if(CMAKE_INSTALL_PREFIX STREQUAL /usr)
  file(INSTALL ${SOURCE}/assets/udev/70-limpid.rules DESTINATION /usr/lib/udev/rules.d)
  file(INSTALL ${SOURCE}/assets/desktop/limits.conf DESTINATION /etc/security/limits.d
    RENAME limpid.conf)
  include(${BUILD}/version/version.cmake)
  execute_process(COMMAND date -uR -d @${limpid_epoch} OUTPUT_VARIABLE date
    OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  file(WRITE ${made}/changelog "limpid (${limpid_version}-0limpid1) unstable; urgency=medium

  * See changelog.gz.

 -- The Limpid authors <maintainers@limpid.invalid>  ${date}
")
  pack(${made}/changelog doc/limpid changelog.Debian)
endif()
