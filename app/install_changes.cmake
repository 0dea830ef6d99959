# Changes of a package, packed, while it is installed. SOURCE, BUILD: the folders.
set(made ${BUILD}/made)

# Without the time or the name of the file, so that the same text gives the same bytes.
function(pack file folder name)
  execute_process(COMMAND gzip -9nc ${file} OUTPUT_FILE ${made}/${name}.gz
    COMMAND_ERROR_IS_FATAL ANY)
  file(INSTALL ${made}/${name}.gz DESTINATION ${CMAKE_INSTALL_PREFIX}/share/${folder})
endfunction()

function(pack_changes package)
  pack(${SOURCE}/CHANGELOG.md doc/${package} changelog)
  if(NOT CMAKE_INSTALL_PREFIX STREQUAL /usr)
    return()
  endif()
  include(${BUILD}/version/version.cmake)
  execute_process(COMMAND date -uR -d @${limpid_epoch} OUTPUT_VARIABLE date
    OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  file(WRITE ${made}/changelog "${package} (${limpid_version}-0limpid1) unstable; urgency=medium

  * See changelog.gz.

 -- The Limpid authors <maintainers@limpid.invalid>  ${date}
")
  pack(${made}/changelog doc/${package} changelog.Debian)
endfunction()
