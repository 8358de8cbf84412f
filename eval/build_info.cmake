# Run at every build (cmake -P): writes build_info.cpp from its template when something changed, so that a commit after
# the last configure is seen and nothing is compiled again for nothing.
# Takes SOURCE_DIR, INPUT, OUTPUT, FUSEBENCH_VERSION, FUSEBENCH_COMPILER, FUSEBENCH_FLAGS.
execute_process(COMMAND git -C "${SOURCE_DIR}" describe --always --dirty --abbrev=12
  OUTPUT_VARIABLE FUSEBENCH_GIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE git_failed)
if(git_failed OR FUSEBENCH_GIT STREQUAL "")
  set(FUSEBENCH_GIT "unknown")
endif()
# The estimator's version is that of its sources: nobody has to remember to raise a number, and a commit that touches
# only documents or the command line leaves finished runs valid.
set(sources "")
foreach(pattern core/*.cpp core/*.hpp datasets/*.cpp datasets/*.hpp)
  file(GLOB_RECURSE found RELATIVE "${SOURCE_DIR}" "${SOURCE_DIR}/${pattern}")
  list(APPEND sources ${found})
endforeach()
foreach(folder eval eval/mesh eval/trajectory)
  file(GLOB found RELATIVE "${SOURCE_DIR}" "${SOURCE_DIR}/${folder}/*.cpp" "${SOURCE_DIR}/${folder}/*.hpp")
  list(APPEND sources ${found})
endforeach()
list(SORT sources)
set(identity "${FUSEBENCH_COMPILER} ${FUSEBENCH_FLAGS}")
foreach(source ${sources})
  file(SHA1 "${SOURCE_DIR}/${source}" digest)
  string(APPEND identity "\n${source} ${digest}")
endforeach()
string(SHA1 FUSEBENCH_ESTIMATOR "${identity}")
string(SUBSTRING "${FUSEBENCH_ESTIMATOR}" 0 12 FUSEBENCH_ESTIMATOR)
configure_file("${INPUT}" "${OUTPUT}" @ONLY)
