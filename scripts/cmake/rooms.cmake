# A library is a role: a list of rooms. A room is a folder and a namespace; it uses only rooms before it in CMakeLists.txt.

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

# fusebench_library(NAME [PROGRAM] [PUBLIC LIBRARY...] [PRIVATE LIBRARY...] [OPTIMIZE LEVEL] [HEADERS SET])
# Defines the static library fusebench_NAME (PROGRAM: the executable NAME). The calls of fusebench_room() that follow add its sources.
#   OPTIMIZE  level of a release build, 3 unless given. Libraries that only read, write and print take 1: half the time to compile,
#             and the same bits in what they compute
#   HEADERS   precompiled headers (see above), "values" unless given, or "json" with OPTIMIZE
function(fusebench_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "PROGRAM" "OPTIMIZE;HEADERS" "PUBLIC;PRIVATE")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "fusebench_library(${name}): unknown arguments ${arg_UNPARSED_ARGUMENTS}")
  endif()
  if(arg_PROGRAM)
    set(library ${name})
    add_executable(${library})
  else()
    set(library fusebench_${name})
    add_library(${library} STATIC)
    set_property(GLOBAL APPEND PROPERTY FUSEBENCH_LIBRARIES ${library})
  endif()
  set_property(GLOBAL PROPERTY FUSEBENCH_CURRENT_LIBRARY ${library})
  fusebench_target_options(${library})
  target_link_libraries(${library} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  set(level 3)
  if(arg_OPTIMIZE)
    set(level ${arg_OPTIMIZE})
    target_compile_options(${library} PRIVATE $<$<CONFIG:Release>:-O${level}>)
  endif()
  if(FUSEBENCH_UNITY)
    set_target_properties(${library} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
  endif()
  if(NOT arg_HEADERS AND arg_OPTIMIZE)
    set(arg_HEADERS json)  # one set of headers the fewer
  elseif(NOT arg_HEADERS)
    set(arg_HEADERS values)
  endif()
  fusebench_precompile(${library} ${arg_HEADERS} ${level})
endfunction()

# fusebench_room(FOLDER [APART] [BARE] [ALONE NAME...] [USES ROOM...] [SOURCES FILE...])
# Adds all sources in FOLDER to the library that was defined last. The name of the room is the last part of FOLDER. Up to 16 sources
# of a library are compiled as one (FUSEBENCH_UNITY): most of the time goes into reading libraries and into their templates, once for
# each compilation. With that off, a change of one source compiles that one alone, and a missing #include shows.
#   APART     each source is compiled alone: most of them give the same names other meanings
#   BARE      without precompiled headers, since the libraries of the sources define macros
#   ALONE     sources (without .cpp) that are compiled alone, since another one gives one of their names another meaning, or since
#             they hide a class with members of types of their own, of which GCC warns if the source is included by another one
#   USES      names of the rooms that its files include; their libraries are linked
#   SOURCES   generated files in addition to those of the folder
function(fusebench_room folder)
  cmake_parse_arguments(PARSE_ARGV 1 arg "APART;BARE" "" "ALONE;USES;SOURCES")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "fusebench_room(${folder}): unknown arguments ${arg_UNPARSED_ARGUMENTS}")
  endif()
  get_property(library GLOBAL PROPERTY FUSEBENCH_CURRENT_LIBRARY)
  get_filename_component(name ${folder} NAME)
  set_property(GLOBAL PROPERTY FUSEBENCH_LIBRARY_OF_${name} ${library})
  set_property(GLOBAL PROPERTY FUSEBENCH_FOLDER_OF_${name} ${folder})
  set_property(GLOBAL PROPERTY FUSEBENCH_USES_OF_${name} ${arg_USES})
  foreach(used IN LISTS arg_USES)
    get_property(other GLOBAL PROPERTY FUSEBENCH_LIBRARY_OF_${used})
    if(NOT other)
      message(FATAL_ERROR "fusebench_room(${folder}): there is no room ${used} before it")
    elseif(NOT other STREQUAL library)
      target_link_libraries(${library} PUBLIC ${other})
    endif()
  endforeach()
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cpp)
  target_sources(${library} PRIVATE ${sources} ${arg_SOURCES})
  if(arg_APART)
    set(alone ${sources})
  else()
    list(TRANSFORM arg_ALONE REPLACE "(.+)" "${PROJECT_SOURCE_DIR}/${folder}/\\1.cpp" OUTPUT_VARIABLE alone)
  endif()
  if(alone)
    set_source_files_properties(${alone} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
  if(arg_BARE)
    set_source_files_properties(${sources} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON SKIP_PRECOMPILE_HEADERS ON)
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
    get_property(folder GLOBAL PROPERTY FUSEBENCH_FOLDER_OF_${next})
    get_property(uses GLOBAL PROPERTY FUSEBENCH_USES_OF_${next})
    list(APPEND folders ${folder})
    list(APPEND todo ${uses})
  endwhile()
  list(SORT folders)
  set(${output} ${folders} PARENT_SCOPE)
endfunction()
