# How every library, program and test of the project is declared.

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)

# Flags that every target of the project gets.
add_library(easydyn_flags INTERFACE)
# The last five are off because g++ 12 raises them falsely inside headers (AVX-512, std::string, fmt).
target_compile_options(easydyn_flags INTERFACE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion
                                               -Wno-maybe-uninitialized -Wno-uninitialized -Wno-array-bounds -Wno-restrict
                                               -Wno-stringop-overflow)
if(EASYDYN_WARNINGS_AS_ERRORS)
  target_compile_options(easydyn_flags INTERFACE -Werror)
endif()
if(EASYDYN_NATIVE)
  target_compile_options(easydyn_flags INTERFACE -march=native)
endif()
if(EASYDYN_SANITIZE)
  # The checks switched off cost a third of the compile time: a null pointer ends in a report of the address sanitizer
  # as well, and Eigen's assertions watch its alignment.
  target_compile_options(easydyn_flags INTERFACE -fsanitize=${EASYDYN_SANITIZE} -fno-omit-frame-pointer
                                                 -fno-sanitize-recover=all -fno-sanitize=null,alignment,object-size)
  target_link_options(easydyn_flags INTERFACE -fsanitize=${EASYDYN_SANITIZE})
  set(CMAKE_CXX_FLAGS_DEBUG "-O1 -g1")  # asserts stay on; -O1 makes the physics fast enough
endif()
if(EASYDYN_ASSERTIONS)
  set(CMAKE_CXX_FLAGS_RELEASE "-O3")  # assert() and the checks of Eigen
  target_compile_definitions(easydyn_flags INTERFACE _GLIBCXX_ASSERTIONS)
else()
  set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
endif()

# easydyn_add_library(NAME SOURCES ... [LINK ...] [LINK_PRIVATE ...])
# Declares the library NAME with the alias easydyn::NAME; headers are found from the repository root.
#
# Public headers, which are installed and checked to compile alone, are all .hpp of the folder and of its
# subfolders without a CMakeLists.txt of their own, except those that say `// Private to ...`.
function(easydyn_add_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK;LINK_PRIVATE" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  add_library(easydyn::${name} ALIAS ${name})
  easydyn_public_headers(headers)
  target_sources(${name} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${headers})
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_compile_features(${name} PUBLIC cxx_std_20)
  if(EASYDYN_NATIVE)
    # Eigen aligns memory after the processor: who links the library must be compiled for the same one.
    target_compile_options(${name} PUBLIC -march=native)
  endif()
  target_link_libraries(${name} PUBLIC Eigen3::Eigen fmt::fmt ${ARG_LINK} PRIVATE
                        $<BUILD_INTERFACE:easydyn_flags> ${ARG_LINK_PRIVATE})
  set_property(GLOBAL APPEND PROPERTY EASYDYN_LIBRARIES ${name})
endfunction()

# Public headers of the current folder, by absolute path.
function(easydyn_public_headers out)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.hpp)
  file(GLOB_RECURSE rooms ${CMAKE_CURRENT_SOURCE_DIR}/*/CMakeLists.txt)
  foreach(room IN LISTS rooms)
    cmake_path(GET room PARENT_PATH folder)
    foreach(header IN LISTS headers)
      cmake_path(IS_PREFIX folder ${header} inside)
      if(inside)
        list(REMOVE_ITEM headers ${header})
      endif()
    endforeach()
  endforeach()
  foreach(header IN LISTS headers)
    file(STRINGS ${header} private REGEX "^// Private to " LIMIT_COUNT 1)
    if(private)
      list(REMOVE_ITEM headers ${header})
    endif()
  endforeach()
  set(${out} ${headers} PARENT_SCOPE)
endfunction()

# easydyn_add_program(NAME SOURCES ... [LINK ...])
function(easydyn_add_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE easydyn_flags ${ARG_LINK})
endfunction()

# easydyn_add_test(NAME SOURCES ... [LINK ...]
#                  [LABELS unit|analytic|published|example|package|browser|slow|no_sanitize ...]
#                  [TIMEOUT seconds] [PROCESSORS n] [SERIAL])
# A GoogleTest program; every TEST in it becomes a ctest entry. PROCESSORS: threads or ranks it uses.
# SERIAL: nothing else may run beside it. Under sanitizers only unit and analytic tests are built, without
# those that are `slow` or `no_sanitize` (physics that takes minutes there).
function(easydyn_add_test name)
  cmake_parse_arguments(ARG "SERIAL" "TIMEOUT;PROCESSORS" "SOURCES;LINK;LABELS" ${ARGN})
  if(EASYDYN_SANITIZE AND (NOT ARG_LABELS MATCHES "unit|analytic" OR ARG_LABELS MATCHES "slow|no_sanitize"))
    return()
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  if(NOT ARG_PROCESSORS)
    set(ARG_PROCESSORS 1)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE easydyn_flags GTest::gmock_main ${ARG_LINK})
  if(EASYDYN_PRECOMPILE)
    easydyn_precompile_test(${name})
  endif()
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 TEST_LIST ${name}_list
                       PROPERTIES TIMEOUT ${ARG_TIMEOUT} PROCESSORS ${ARG_PROCESSORS} RUN_SERIAL ${ARG_SERIAL})
  # Several labels do not pass through the discovery as one value: they are set when ctest has read its list.
  set(labels_file ${CMAKE_CURRENT_BINARY_DIR}/${name}_labels.cmake)
  file(WRITE ${labels_file}
       "if(${name}_list)\n  set_tests_properties(\${${name}_list} PROPERTIES LABELS \"${ARG_LABELS}\")\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${labels_file})
endfunction()

# Gives a program of tests the precompiled headers of GoogleTest, Eigen and {fmt}, which all of them share: they are
# half of the compile time of a test under the sanitizers.
function(easydyn_precompile_test name)
  if(NOT TARGET easydyn_test_headers)
    set(source ${PROJECT_BINARY_DIR}/test_headers.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "// Carries the precompiled headers of the tests.\n")
    add_library(easydyn_test_headers OBJECT ${source})
    target_link_libraries(easydyn_test_headers PRIVATE easydyn_flags Eigen3::Eigen fmt::fmt GTest::gmock_main)
    target_precompile_headers(easydyn_test_headers PRIVATE <Eigen/Dense> <fmt/format.h> <gmock/gmock.h> <gtest/gtest.h>)
  endif()
  target_precompile_headers(${name} REUSE_FROM easydyn_test_headers)
endfunction()
