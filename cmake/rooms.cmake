# fatmc_room(name SOURCES a.cc ... [LINKS targets of rooms above] [PRIVATE libraries that stay inside])
# One static library a room; its link list is the only way to reach another room's symbols.
function(fatmc_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;LINKS;PRIVATE" ${ARGN})
  add_library(${name} STATIC ${ROOM_SOURCES})
  target_link_libraries(${name} PUBLIC ${ROOM_LINKS} PRIVATE fatmc_settings ${ROOM_PRIVATE})
  target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
endfunction()

# fatmc_program(name SOURCES ... LINKS ...)
function(fatmc_program name)
  cmake_parse_arguments(PROGRAM "" "" "SOURCES;LINKS" ${ARGN})
  add_executable(${name} ${PROGRAM_SOURCES})
  target_link_libraries(${name} PRIVATE fatmc_settings ${PROGRAM_LINKS})
endfunction()

# fatmc_test(name SOURCES ... LINKS ... [LABELS unit|statistical|system|fuzz|validation])
# One GoogleTest program; every TEST in it is a ctest entry.
include(GoogleTest)
function(fatmc_test name)
  cmake_parse_arguments(TEST "" "TIMEOUT" "SOURCES;LINKS;LABELS" ${ARGN})
  if(NOT TEST_LABELS)
    set(TEST_LABELS unit)
  endif()
  if(NOT TEST_TIMEOUT)
    set(TEST_TIMEOUT 120)
  endif()
  add_executable(${name} ${TEST_SOURCES})
  target_link_libraries(${name} PRIVATE fatmc_settings ${TEST_LINKS} GTest::gmock GTest::gtest_main)
  gtest_discover_tests(${name}
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
    DISCOVERY_TIMEOUT 60
    PROPERTIES LABELS "${TEST_LABELS}" TIMEOUT ${TEST_TIMEOUT})
endfunction()
