# easydyn_find_rpath(OUT BINDIR LIBDIR): where an installed program of BINDIR looks for modules in LIBDIR/easydyn-2. Relative
# to the program, so that the whole prefix may be moved, unless one of both is absolute.
function(easydyn_find_rpath out bindir libdir)
  if(IS_ABSOLUTE "${libdir}")
    set(rpath "${libdir}")
  elseif(IS_ABSOLUTE "${bindir}")
    set(rpath "${CMAKE_INSTALL_PREFIX}/${libdir}")
  else()
    file(RELATIVE_PATH way "/prefix/${bindir}" "/prefix/${libdir}")
    set(rpath "$ORIGIN/${way}")
  endif()
  set(${out} "${rpath}/easydyn-2" PARENT_SCOPE)
endfunction()
