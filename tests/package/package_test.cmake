# cmake -DBUILD=... -DSOURCE=... -DSCRATCH=... -P package_test.cmake
# Installs the build tree BUILD under SCRATCH, then configures, builds and runs the project SOURCE against it.
file(REMOVE_RECURSE ${SCRATCH})
set(prefix ${SCRATCH}/installed)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}: ${status}\n${output}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${SCRATCH}/build -G Ninja -DCMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
run(${SCRATCH}/build/double_pendulum)
run(${SCRATCH}/build/result_file ${SCRATCH}/numbers.h5)

# Nothing outside include/easydyn-2, and no private header.
file(GLOB_RECURSE headers RELATIVE ${prefix}/include ${prefix}/include/*)
foreach(header IN LISTS headers)
  if(NOT header MATCHES "^easydyn-2/(easydyn|vehicles|track|soil)/.*\\.hpp$")
    message(FATAL_ERROR "installed in a wrong place: include/${header}")
  endif()
  file(STRINGS ${prefix}/include/${header} private REGEX "^// Private to ")
  if(private)
    message(FATAL_ERROR "a private header was installed: include/${header}")
  endif()
endforeach()
