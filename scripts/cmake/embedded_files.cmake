# Source files that the build writes: what the binary carries within itself. Each sets a variable that names the file.

# fusebench_embed_toml(VARIABLE FOLDER HEADER NAMESPACE TYPE FUNCTION): configs/FOLDER/*.toml, written again when a file changes;
# a new file is seen by the glob, a removed one by the names in the command.
function(fusebench_embed_toml variable folder header namespace type function)
  file(GLOB files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/configs/${folder}/*.toml)
  string(MD5 names "${files}")
  set(output ${PROJECT_BINARY_DIR}/embedded/${folder}.cpp)
  set(script ${PROJECT_SOURCE_DIR}/scripts/cmake/embed_toml.cmake)
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DFOLDER=${folder} -DROOT=${PROJECT_SOURCE_DIR} -DNAMES=${names} -DOUTPUT=${output}
      -DHEADER=${header} -DNAMESPACE=${namespace} -DTYPE=${type} -DFUNCTION=${function} -P ${script}
    DEPENDS ${files} ${script}
    COMMENT "Embedding configs/${folder}"
    VERBATIM)
  set(${variable} ${output} PARENT_SCOPE)
endfunction()

fusebench_embed_toml(catalogue_files recordings datasets/calibration/recording_catalogue.hpp calibration CatalogueFile
  catalogue_files)
fusebench_embed_toml(published_files paper eval/compare/tables/published_table.hpp tables PublishedFile published_files)
fusebench_embed_toml(reproduction_files reproduction eval/compare/reproduction/table1_protocol.hpp reproduction ReproductionFile
  reproduction_files)

# Pages carry their style, script and the chart library within themselves.
find_file(CHART_JS chart.min.js PATHS /usr/share/javascript/chart.js REQUIRED)
find_file(THREE_JS three.min.js PATHS /usr/share/javascript/three REQUIRED)
find_file(ORBIT_CONTROLS_JS OrbitControls.js PATHS /usr/share/javascript/three/examples/js/controls REQUIRED)
set(page_folder ${PROJECT_SOURCE_DIR}/eval/page)
set(page_assets ${PROJECT_BINARY_DIR}/embedded/page_assets.cpp)
set(page_sources ${page_folder}/page.css)
set(page_files page_style=${page_folder}/page.css chart_library=${CHART_JS} scene_library=${THREE_JS}
  scene_controls=${ORBIT_CONTROLS_JS})
foreach(script chart_axes chart_plugins page timeline zoom scene_camera scene)
  list(APPEND page_sources ${page_folder}/${script}.js)
  list(APPEND page_files ${script}_script=${page_folder}/${script}.js)
endforeach()
string(REPLACE ";" "," page_files "${page_files}")
add_custom_command(OUTPUT ${page_assets}
  COMMAND ${CMAKE_COMMAND} -DOUTPUT=${page_assets} -DHEADER=eval/page/page_assets.hpp -DNAMESPACE=page -DFILES=${page_files}
    -P ${PROJECT_SOURCE_DIR}/scripts/cmake/embed_files.cmake
  DEPENDS ${page_sources} ${CHART_JS} ${THREE_JS} ${ORBIT_CONTROLS_JS}
    ${PROJECT_SOURCE_DIR}/scripts/cmake/embed_files.cmake
  COMMENT "Embedding the files of pages"
  VERBATIM)

set(build_info ${PROJECT_BINARY_DIR}/embedded/build_info.cpp)
# It changes with every source of the estimator: compiled alone.
set_source_files_properties(${build_info} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)

# What was built, from what: written at every build, so that a record never names an older commit. The estimator's version is
# that of the rooms behind ROOM, which is known once all rooms are.
function(fusebench_write_build_info room)
  fusebench_folders_behind(${room} folders)
  string(REPLACE ";" "," folders "${folders}")
  string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
  add_custom_target(fusebench_build_info ALL
    COMMAND ${CMAKE_COMMAND} -DSOURCE_DIR=${PROJECT_SOURCE_DIR}
      -DINPUT=${PROJECT_SOURCE_DIR}/eval/record/build_info.cpp.in -DOUTPUT=${build_info} -DFOLDERS=${folders}
      -DFUSEBENCH_VERSION=${PROJECT_VERSION} "-DFUSEBENCH_COMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
      "-DFUSEBENCH_FLAGS=${CMAKE_CXX_FLAGS_${build_type}} -march=${FUSEBENCH_ARCH} -ffp-contract=off"
      -P ${PROJECT_SOURCE_DIR}/scripts/cmake/build_info.cmake
    BYPRODUCTS ${build_info}
    VERBATIM)
  add_dependencies(fusebench_record fusebench_build_info)
endfunction()
