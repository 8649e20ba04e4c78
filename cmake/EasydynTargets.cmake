# How every library, program and test of the project is declared.

# Flags that every target of the project gets.
add_library(easydyn_flags INTERFACE)
target_compile_options(easydyn_flags INTERFACE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion)
if(EASYDYN_WARNINGS_AS_ERRORS)
  target_compile_options(easydyn_flags INTERFACE -Werror)
endif()
if(EASYDYN_NATIVE)
  target_compile_options(easydyn_flags INTERFACE -march=native)
endif()
if(EASYDYN_SANITIZE)
  target_compile_options(easydyn_flags INTERFACE -fsanitize=${EASYDYN_SANITIZE} -fno-omit-frame-pointer
                                                 -fno-sanitize-recover=all)
  target_link_options(easydyn_flags INTERFACE -fsanitize=${EASYDYN_SANITIZE})
endif()
if(CMAKE_BUILD_TYPE STREQUAL "Release")
  set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
endif()

# easydyn_add_library(NAME SOURCES ... [LINK ...] [LINK_PRIVATE ...])
# Declares the library NAME with the alias easydyn::NAME; headers are found from the repository root.
function(easydyn_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;LINK_PRIVATE" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  add_library(easydyn::${name} ALIAS ${name})
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                            $<INSTALL_INTERFACE:include/easydyn-2>)
  target_link_libraries(${name} PUBLIC Eigen3::Eigen fmt::fmt ${ARG_LINK} PRIVATE
                        $<BUILD_INTERFACE:easydyn_flags> ${ARG_LINK_PRIVATE})
endfunction()

# easydyn_add_program(NAME SOURCES ... [LINK ...])
function(easydyn_add_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE easydyn_flags ${ARG_LINK})
endfunction()

# easydyn_add_test(NAME SOURCES ... [LINK ...] [LABELS unit|analytic|published|example|package|browser|slow ...]
#                  [TIMEOUT seconds])
# A GoogleTest program; every TEST in it becomes a ctest entry.
function(easydyn_add_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;LINK;LABELS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE easydyn_flags GTest::gmock_main ${ARG_LINK})
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT})
endfunction()
