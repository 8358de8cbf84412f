# cmake -DFOLDER=BUILD -DTARGET=PROGRAM -DLISTS=FOLDER -P build_program.cmake: builds a test program before its tests run. Fails
# where the program has other tests than ctest read when it started, which then have not run.
# The tests of the lists that the program has written; without the bytes and addresses of parameters, which differ between runs.
function(read_lists result)
  file(GLOB lists ${LISTS}/${TARGET}*_tests.cmake)
  set(tests "")
  foreach(list IN LISTS lists)
    file(READ ${list} content)
    string(REGEX REPLACE "-byte object <[^>]*>|0x[0-9a-f]+" "" content "${content}")
    string(APPEND tests "${content}")
  endforeach()
  set(${result} "${tests}" PARENT_SCOPE)
endfunction()

read_lists(before)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${FOLDER} --target ${TARGET} RESULT_VARIABLE status OUTPUT_VARIABLE output
  ERROR_VARIABLE output)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${output}")
endif()
read_lists(after)
if(NOT before STREQUAL after)
  message(FATAL_ERROR "${TARGET} has been built with other tests than before: run ctest again")
endif()
