# fusebench_ceres: Ceres for the rooms. Debian has a static library of it, compiled without AVX, whose copies of Eigen's functions
# must not be taken for ours (scripts/isolate_eigen.sh): memory that one of them allocates and the other frees is lost, and
# which of them a linker keeps is chance.
get_target_property(ceres_type Ceres::ceres TYPE)
if(NOT ceres_type STREQUAL STATIC_LIBRARY)
  message(FATAL_ERROR "Ceres is expected as a static library, as in Debian 12; here it is of the type ${ceres_type}")
endif()
set(ceres_object ${CMAKE_CURRENT_BINARY_DIR}/ceres_isolated.o)
add_custom_command(OUTPUT ${ceres_object}
  COMMAND ${PROJECT_SOURCE_DIR}/scripts/isolate_eigen.sh $<TARGET_FILE:Ceres::ceres> ${ceres_object}
  DEPENDS ${PROJECT_SOURCE_DIR}/scripts/isolate_eigen.sh
  COMMENT "Taking Eigen's functions of Ceres apart from ours"
  VERBATIM)
add_library(fusebench_ceres STATIC ${ceres_object})
set_source_files_properties(${ceres_object} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
set_target_properties(fusebench_ceres PROPERTIES LINKER_LANGUAGE CXX)
# All that its own target brings, but for the archive.
get_target_property(ceres_includes Ceres::ceres INTERFACE_INCLUDE_DIRECTORIES)
get_target_property(ceres_libraries Ceres::ceres INTERFACE_LINK_LIBRARIES)
target_include_directories(fusebench_ceres SYSTEM INTERFACE ${ceres_includes})
target_link_libraries(fusebench_ceres INTERFACE ${ceres_libraries})
set_property(GLOBAL APPEND PROPERTY FUSEBENCH_LIBRARIES fusebench_ceres)
