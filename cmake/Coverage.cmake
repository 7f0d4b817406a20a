# The target `coverage`: runs the tests and writes build/coverage/coverage.txt
# (a row a file), .html and .json (`./setup.sh docs` installs gcovr).
find_program(GCOVR gcovr)
if(NOT GCOVR)
  message(FATAL_ERROR "gcovr is missing (./setup.sh docs)")
endif()
get_property(everything DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}
             PROPERTY BUILDSYSTEM_TARGETS)
list(FILTER everything INCLUDE REGEX "_test$")
add_custom_target(coverage
  COMMAND ${CMAKE_CTEST_COMMAND} --test-dir ${CMAKE_BINARY_DIR} -j2
          --timeout 900 --output-on-failure
  COMMAND ${GCOVR} --root ${CMAKE_SOURCE_DIR} --object-directory ${CMAKE_BINARY_DIR}
          --filter ${CMAKE_SOURCE_DIR}/src --filter ${CMAKE_SOURCE_DIR}/factors
          --filter ${CMAKE_SOURCE_DIR}/problems
          --exclude-throw-branches --exclude-unreachable-branches
          --gcov-ignore-parse-errors --print-summary
          --txt ${CMAKE_BINARY_DIR}/coverage.txt
          --json-summary ${CMAKE_BINARY_DIR}/coverage.json --json-summary-pretty
          --html-details ${CMAKE_BINARY_DIR}/coverage.html
          ${CMAKE_BINARY_DIR}
  DEPENDS hindsight ${everything}
  WORKING_DIRECTORY ${CMAKE_BINARY_DIR}
  USES_TERMINAL VERBATIM)
