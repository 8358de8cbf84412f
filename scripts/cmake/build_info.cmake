# Run at every build (cmake -P): writes build_info.cpp from its template when something changed, so that a commit after
# the last configure is seen and nothing is compiled again for nothing.
# Takes SOURCE_DIR, INPUT, OUTPUT, FOLDERS (of the rooms that numbers depend on, separated by commas), FUSEBENCH_VERSION,
# FUSEBENCH_COMPILER, FUSEBENCH_FLAGS.
execute_process(COMMAND git -C "${SOURCE_DIR}" describe --always --dirty --abbrev=12
  OUTPUT_VARIABLE FUSEBENCH_GIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE git_failed)
if(git_failed OR FUSEBENCH_GIT STREQUAL "")
  set(FUSEBENCH_GIT "unknown")
endif()
# The estimator's version is that of its sources: nobody has to remember to raise a number, and a commit that touches
# only documents, the command line, the simulator or the inspection leaves finished runs valid.
string(REPLACE "," ";" FOLDERS "${FOLDERS}")
set(identity "${FUSEBENCH_COMPILER} ${FUSEBENCH_FLAGS}")
foreach(folder IN LISTS FOLDERS)
  file(GLOB sources RELATIVE "${SOURCE_DIR}" "${SOURCE_DIR}/${folder}/*.cpp" "${SOURCE_DIR}/${folder}/*.hpp")
  list(SORT sources)
  foreach(source IN LISTS sources)
    file(SHA1 "${SOURCE_DIR}/${source}" digest)
    string(APPEND identity "\n${source} ${digest}")
  endforeach()
endforeach()
string(SHA1 FUSEBENCH_ESTIMATOR "${identity}")
string(SUBSTRING "${FUSEBENCH_ESTIMATOR}" 0 12 FUSEBENCH_ESTIMATOR)
configure_file("${INPUT}" "${OUTPUT}" @ONLY)
