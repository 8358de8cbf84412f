# A room is a folder, a library and a namespace. It uses only rooms that stand before it in CMakeLists.txt.

# Flags of every target of ours. -march is public: it decides the alignment of Eigen's types, so all code that shares them
# must agree. Debian builds Ceres (a static library) without AVX, so that Eigen's fixed-size types align to 16 bytes in it; here
# as well. No contraction of a*b+c, which would change bits between compilers. GCC 12 sees array bounds, null pointers and reads
# beyond a string in inlined library code (Eigen's AVX loads, CLI11, std::string's move) where there are none. GCC collects garbage
# at 1 GB (twice the parameter, in kB) instead of 256 MB: a collection visits the precompiled headers too, a tenth of the time.
function(fusebench_target_options target)
  cmake_parse_arguments(arg "" "ARCH" "" ${ARGN})
  if(NOT arg_ARCH)
    set(arg_ARCH ${FUSEBENCH_ARCH})
  endif()
  target_compile_options(${target} PUBLIC -march=${arg_ARCH} PRIVATE -ffp-contract=off
    $<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=500000>
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wnon-virtual-dtor -Woverloaded-virtual
    -Wold-style-cast -Wno-array-bounds -Wno-stringop-overread -Wno-maybe-uninitialized -Wno-psabi $<$<BOOL:${FUSEBENCH_WERROR}>:-Werror>)
  target_compile_definitions(${target} PUBLIC EIGEN_MAX_ALIGN_BYTES=16)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:include/fusebench>)
endfunction()

# Headers of the libraries that a target's sources begin with, compiled once for all targets of the same flags. Ours are not
# among them, so that a change of one compiles again what includes it and nothing else.
#   values   the standard library, Eigen with the types of common expressions, fmt
#   json     and nlohmann-json       cli   and CLI11 as well
#   tests    values, and GoogleTest
set(FUSEBENCH_HEADERS_values <algorithm> <array> <chrono> <cmath> <cstddef> <cstdint> <filesystem> <fstream> <functional>
  <limits> <map> <memory> <numbers> <optional> <set> <span> <sstream> <string> <string_view> <system_error> <tuple> <utility>
  <variant> <vector> ${CMAKE_CURRENT_LIST_DIR}/eigen_expressions.hpp <fmt/format.h> <fmt/ranges.h> <tl/expected.hpp>)
set(FUSEBENCH_HEADERS_json ${FUSEBENCH_HEADERS_values} <nlohmann/json.hpp>)
set(FUSEBENCH_HEADERS_cli ${FUSEBENCH_HEADERS_json} <CLI/CLI.hpp>)
set(FUSEBENCH_HEADERS_tests ${FUSEBENCH_HEADERS_values} <gtest/gtest.h>)
function(fusebench_precompile target headers level)
  set(key FUSEBENCH_PRECOMPILED_${headers}_${level})
  get_property(owner GLOBAL PROPERTY ${key})
  if(owner)
    target_precompile_headers(${target} REUSE_FROM ${owner})
  else()
    target_precompile_headers(${target} PRIVATE ${FUSEBENCH_HEADERS_${headers}})
    set_property(GLOBAL PROPERTY ${key} ${target})
  endif()
endfunction()

# fusebench_room(FOLDER [PROGRAM] [APART] [ALONE NAME...] [USES ROOM...] [PUBLIC LIBRARY...] [PRIVATE LIBRARY...] [SOURCES FILE...]
#                [OPTIMIZE LEVEL] [HEADERS SET])
# Defines the library fusebench_<last name of FOLDER> of all sources in FOLDER (PROGRAM: the program fusebench). They are compiled
# as one (FUSEBENCH_UNITY): most of the time goes into reading libraries and into their templates, once for each
# compilation. With that off, a change of one source compiles that one alone, and a missing #include shows.
#   APART     each source is compiled alone: most of them give the same names other meanings
#   ALONE     sources (without .cpp) that are, since another one gives one of their names another meaning, or since they hide a class
#             with members of types of their own, of which GCC warns wherever the source is not the file that it was given
#   USES      last names of the rooms that its files include
#   SOURCES   generated files beside those of the folder
#   OPTIMIZE  level of a release build, 3 unless given. Rooms that only read, write and print take 1: half the time to compile,
#             and not a bit of difference in what they compute.
#   HEADERS   precompiled headers (see above), "values" unless given, or "json" with OPTIMIZE; "none" for rooms whose libraries
#             define macros
function(fusebench_room folder)
  cmake_parse_arguments(PARSE_ARGV 1 arg "PROGRAM;APART" "OPTIMIZE;HEADERS" "ALONE;USES;PUBLIC;PRIVATE;SOURCES")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "fusebench_room(${folder}): unknown arguments ${arg_UNPARSED_ARGUMENTS}")
  endif()
  get_filename_component(name ${folder} NAME)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cpp)
  list(TRANSFORM arg_USES PREPEND fusebench_ OUTPUT_VARIABLE used)
  if(arg_PROGRAM)
    set(room fusebench)
    add_executable(${room} ${sources} ${arg_SOURCES})
  else()
    set(room fusebench_${name})
    set_property(GLOBAL APPEND PROPERTY FUSEBENCH_LIBRARIES ${room})
    set(kind STATIC)
    if(NOT sources AND NOT arg_SOURCES)  # headers only
      set(kind INTERFACE)
    endif()
    add_library(${room} ${kind} ${sources} ${arg_SOURCES})
  endif()
  set_target_properties(${room} PROPERTIES FUSEBENCH_FOLDER ${folder} FUSEBENCH_USES "${arg_USES}")
  if(kind STREQUAL INTERFACE)
    target_link_libraries(${room} INTERFACE ${used} ${arg_PUBLIC})
    return()
  endif()
  fusebench_target_options(${room})
  set(level 3)
  if(arg_OPTIMIZE)
    set(level ${arg_OPTIMIZE})
    target_compile_options(${room} PRIVATE $<$<CONFIG:Release>:-O${level}>)
  endif()
  if(FUSEBENCH_UNITY AND NOT arg_APART)
    set_target_properties(${room} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
    foreach(source IN LISTS arg_ALONE)
      set_source_files_properties(${PROJECT_SOURCE_DIR}/${folder}/${source}.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endforeach()
  endif()
  target_link_libraries(${room} PUBLIC ${used} ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  if(NOT arg_HEADERS AND arg_OPTIMIZE)
    set(arg_HEADERS json)  # one set of headers the fewer
  elseif(NOT arg_HEADERS)
    set(arg_HEADERS values)
  endif()
  if(NOT arg_HEADERS STREQUAL none)
    fusebench_precompile(${room} ${arg_HEADERS} ${level})
  endif()
endfunction()

# The folders of a room and of all rooms that it uses, directly or not: what its results depend on.
function(fusebench_folders_behind name output)
  set(todo ${name})
  set(seen "")
  set(folders "")
  while(todo)
    list(POP_FRONT todo next)
    if(next IN_LIST seen)
      continue()
    endif()
    list(APPEND seen ${next})
    get_target_property(folder fusebench_${next} FUSEBENCH_FOLDER)
    get_target_property(uses fusebench_${next} FUSEBENCH_USES)
    list(APPEND folders ${folder})
    list(APPEND todo ${uses})
  endwhile()
  list(SORT folders)
  set(${output} ${folders} PARENT_SCOPE)
endfunction()
