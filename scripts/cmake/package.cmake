# cpack: a Debian package of what is installed (docs/install.md).
set(CPACK_PACKAGE_NAME fusebench)
set(CPACK_PACKAGE_VENDOR FuseBench)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "evaluation and benchmarking of RGB-D-inertial reconstruction")
set(CPACK_PACKAGE_DESCRIPTION "FuseBench runs an RGB-D-inertial reconstruction system, its ablations and other systems over
recordings, offline and reproducibly to the byte, and measures the errors of trajectories, meshes,
consistency and patches. It reads TUM RGB-D, ICL-NUIM, ETH3D and ZR300 recordings, simulates some
with exact truth, and evaluates what any other system made.

The processor has to have AVX2 (x86-64-v3). The libraries with their headers are included; what they
need to be compiled against is suggested.")
set(CPACK_PACKAGE_FILE_NAME fusebench)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)

# As those who write the program are to be cited.
file(STRINGS ${PROJECT_SOURCE_DIR}/CITATION.cff authors REGEX "^  - name: ")
string(REGEX REPLACE "^  - name: \"(.*)\"$" "\\1" CPACK_PACKAGE_CONTACT "${authors}")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
# The libraries that the program and its module are linked with, as the packages of this system are called.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS gnuplot-nox)  # draws figures
# For programs that use the libraries: all of scripts/packages.txt that is one, but for those of tests and of the module.
file(STRINGS ${PROJECT_SOURCE_DIR}/scripts/packages.txt packages REGEX "-dev$")
list(FILTER packages EXCLUDE REGEX "gtest|gmock|benchmark|openimageio")
list(JOIN packages ", " packages)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "python3, python3-pandas, python3-matplotlib, ${packages}")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/scripts/packaging/prerm)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# The licence in the form that Debian's tools read.
file(STRINGS ${PROJECT_SOURCE_DIR}/LICENSE licence_lines)
set(LICENCE_TEXT "")
foreach(line IN LISTS licence_lines)
  string(STRIP "${line}" line)
  if(line STREQUAL "")
    set(line ".")
  endif()
  if(line MATCHES "^Copyright (.*)$")
    set(COPYRIGHT_LINE "${CMAKE_MATCH_1}")
  endif()
  string(APPEND LICENCE_TEXT " ${line}\n")
endforeach()
configure_file(${PROJECT_SOURCE_DIR}/scripts/packaging/copyright.in ${PROJECT_BINARY_DIR}/packaging/copyright @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/packaging/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
include(CPack)
