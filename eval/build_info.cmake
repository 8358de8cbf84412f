# Run at every build (cmake -P): writes build_info.cpp from its template when something changed, so that a commit after
# the last configure is seen and nothing is compiled again for nothing.
# Takes SOURCE_DIR, INPUT, OUTPUT, FUSEBENCH_VERSION, FUSEBENCH_COMPILER, FUSEBENCH_FLAGS.
execute_process(COMMAND git -C "${SOURCE_DIR}" describe --always --dirty --abbrev=12
  OUTPUT_VARIABLE FUSEBENCH_GIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE git_failed)
if(git_failed OR FUSEBENCH_GIT STREQUAL "")
  set(FUSEBENCH_GIT "unknown")
endif()
configure_file("${INPUT}" "${OUTPUT}" @ONLY)
