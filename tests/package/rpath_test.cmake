# cmake -DSOURCE=... -P rpath_test.cmake: where installed programs look for modules.
include(${SOURCE}/cmake/EasydynRpath.cmake)
set(CMAKE_INSTALL_PREFIX /opt/easydyn)

function(expect bindir libdir expected)
  easydyn_find_rpath(rpath "${bindir}" "${libdir}")
  if(NOT rpath STREQUAL expected)
    message(FATAL_ERROR "${bindir}, ${libdir}: ${rpath}, must be ${expected}")
  endif()
endfunction()

expect(bin lib "$ORIGIN/../lib/easydyn-2")
expect(bin lib/x86_64-linux-gnu "$ORIGIN/../lib/x86_64-linux-gnu/easydyn-2")
expect(tools/bin lib "$ORIGIN/../../lib/easydyn-2")
expect(bin /usr/lib64 "/usr/lib64/easydyn-2")
expect(/usr/bin /usr/lib64 "/usr/lib64/easydyn-2")
expect(/usr/bin lib "/opt/easydyn/lib/easydyn-2")
