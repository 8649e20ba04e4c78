# What `cmake --install` puts down: headers under include/easydyn-2/, libraries under lib/easydyn-2/, the program
# `soil`, and the files by which an outside project says
#
#   find_package(easydyn 2 REQUIRED)
#   target_link_libraries(my_program PRIVATE easydyn::easydyn)

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(easydyn_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/easydyn-2)
get_property(easydyn_libraries GLOBAL PROPERTY EASYDYN_LIBRARIES)

install(TARGETS ${easydyn_libraries} EXPORT easydyn
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/easydyn-2
        FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/easydyn-2)
install(EXPORT easydyn NAMESPACE easydyn:: FILE easydynTargets.cmake DESTINATION ${easydyn_package_dir})
if(TARGET soil_program)
  install(TARGETS soil_program)
endif()
if(TARGET soil_mpi)  # soil_program finds it there
  install(TARGETS soil_mpi LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/easydyn-2)
endif()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/easydynConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/easydynConfig.cmake INSTALL_DESTINATION ${easydyn_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/easydynConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES ${PROJECT_BINARY_DIR}/easydynConfig.cmake ${PROJECT_BINARY_DIR}/easydynConfigVersion.cmake
        DESTINATION ${easydyn_package_dir})
