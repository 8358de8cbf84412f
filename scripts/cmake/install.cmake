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

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/fusebench)
install(EXPORT fusebench_targets NAMESPACE fusebench:: DESTINATION ${package_folder})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/fusebench-config.cmake.in
  ${CMAKE_BINARY_DIR}/fusebench-config.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/fusebench-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/fusebench-config.cmake ${CMAKE_BINARY_DIR}/fusebench-config-version.cmake
  DESTINATION ${package_folder})
