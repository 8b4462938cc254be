# Included by CTest before it runs anything: lists the suites of a test program and registers each as
# one test, so that what a suite's cases share (SetUpTestSuite, the loading of libraries) is done
# once. A suite whose name begins with "Nightly" has the label `nightly`.
#
# rubble_discover_suites(PROGRAM LISTING FOLDER LABEL ENVIRONMENT TIMEOUT): tests are called
# FOLDER.SUITE. LISTING is a file that keeps the list while the program stays the same; TIMEOUT is in
# seconds, of each suite.
function(rubble_discover_suites program listing folder label environment timeout)
  if(NOT EXISTS ${program})
    get_filename_component(name ${program} NAME)
    add_test(${name}_NOT_BUILT ${name}_NOT_BUILT)
    return()
  endif()
  if(NOT EXISTS ${listing} OR ${program} IS_NEWER_THAN ${listing})
    execute_process(COMMAND ${program} --gtest_list_tests
      OUTPUT_VARIABLE text ERROR_VARIABLE text RESULT_VARIABLE failed)
    if(failed)
      message(FATAL_ERROR "${program} --gtest_list_tests failed:\n${text}")
    endif()
    file(WRITE ${listing} "${text}")
  endif()
  file(STRINGS ${listing} suites REGEX "^[^ ].*\\.( |$)")
  foreach(suite IN LISTS suites)
    string(REGEX REPLACE "\\.( .*)?$" "" suite "${suite}")
    set(labels ${label})
    set(limit ${timeout})
    if(suite MATCHES "(^|/)Nightly")
      list(APPEND labels nightly)
      set(limit 3600)
    endif()
    set(test ${folder}.${suite})
    add_test(${test} ${program} "--gtest_filter=${suite}.*" --gtest_brief=1)
    set_tests_properties(${test} PROPERTIES
      LABELS "${labels}" TIMEOUT ${limit} ENVIRONMENT "${environment}")
  endforeach()
endfunction()
