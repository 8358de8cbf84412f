# cmake --install: the program with its configurations, the libraries with a CMake package, and the documentation.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(rooms GLOBAL PROPERTY FUSEBENCH_LIBRARIES)
install(TARGETS fusebench ${rooms} EXPORT fusebench_targets
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
# The module with the image library: the program finds it from where itself is. Programs that link the installed libraries
# find it by the prefix that these are installed in.
set(module_folder ${CMAKE_INSTALL_LIBDIR}/fusebench)
install(TARGETS fusebench_image_module LIBRARY DESTINATION ${module_folder})
set_target_properties(fusebench PROPERTIES INSTALL_RPATH "$ORIGIN/../${module_folder}")
target_link_options(fusebench_images INTERFACE $<INSTALL_INTERFACE:LINKER:-rpath,$<INSTALL_PREFIX>/${module_folder}>)
foreach(folder core datasets eval)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} DESTINATION include/fusebench FILES_MATCHING PATTERN "*.hpp"
    PATTERN cli EXCLUDE)
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/configs DESTINATION ${CMAKE_INSTALL_DATADIR}/fusebench)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})
# Where Debian's Python looks, if the prefix is /usr; from another one, PYTHONPATH names it (docs/files.md).
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scripts/python/fusebench_runs DESTINATION lib/python3/dist-packages
  FILES_MATCHING PATTERN "*.py" PATTERN "*.json")
install(FILES ${PROJECT_SOURCE_DIR}/scripts/python/report_figures.ipynb DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples)

# Manual pages and completions are what the program itself says, each time that it was linked.
find_program(GZIP_PROGRAM gzip REQUIRED)
set(shell_files ${PROJECT_BINARY_DIR}/shell)
add_custom_command(TARGET fusebench POST_BUILD
  COMMAND ${CMAKE_COMMAND} -E rm -rf ${shell_files}
  COMMAND fusebench manual ${shell_files}/man1
  COMMAND ${GZIP_PROGRAM} -9nr ${shell_files}/man1
  COMMAND fusebench completion bash > ${shell_files}/fusebench
  COMMAND fusebench completion zsh > ${shell_files}/_fusebench
  COMMENT "Writing manual pages and completions"
  VERBATIM)
install(DIRECTORY ${shell_files}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR})
install(FILES ${shell_files}/fusebench DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${shell_files}/_fusebench DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/fusebench)
install(EXPORT fusebench_targets NAMESPACE fusebench:: DESTINATION ${package_folder})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/fusebench-config.cmake.in
  ${CMAKE_BINARY_DIR}/fusebench-config.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/fusebench-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/fusebench-config.cmake ${CMAKE_BINARY_DIR}/fusebench-config-version.cmake
  DESTINATION ${package_folder})
