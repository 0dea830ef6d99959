# What has to be packed while it is installed, and what belongs to the system alone.
# SOURCE, BUILD: the folders.
set(prefix $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX})

file(MAKE_DIRECTORY ${prefix}/bin)
file(CREATE_LINK ../libexec/limpid/limpid ${prefix}/bin/limpid SYMBOLIC)

# Without the time or the name of the file, so that the same text gives the same bytes.
function(pack file into)
  cmake_path(GET into PARENT_PATH folder)
  file(MAKE_DIRECTORY ${folder})
  execute_process(COMMAND gzip -9nc ${file} OUTPUT_FILE ${into} COMMAND_ERROR_IS_FATAL ANY)
  file(CHMOD ${into} PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
endfunction()

file(GLOB pages ${BUILD}/made/man/man1/*.1)
foreach(page ${pages})
  cmake_path(GET page FILENAME name)
  pack(${page} ${prefix}/share/man/man1/${name}.gz)
endforeach()
pack(${SOURCE}/CHANGELOG.md ${prefix}/share/doc/limpid/changelog.gz)

if(CMAKE_INSTALL_PREFIX STREQUAL /usr)
  file(INSTALL ${SOURCE}/assets/udev/70-limpid.rules DESTINATION /usr/lib/udev/rules.d)
  file(INSTALL ${SOURCE}/assets/desktop/limits.conf DESTINATION /etc/security/limits.d
    RENAME limpid.conf)
  include(${BUILD}/version/version.cmake)
  execute_process(COMMAND date -uR -d @${limpid_epoch} OUTPUT_VARIABLE date
    OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  file(WRITE ${BUILD}/changelog "limpid (${limpid_version}-0limpid1) unstable; urgency=medium

  * See changelog.gz.

 -- The Limpid authors <maintainers@limpid.invalid>  ${date}
")
  pack(${BUILD}/changelog ${prefix}/share/doc/limpid/changelog.Debian.gz)
endif()
