# Installs the libraries, headers and program, so that find_package(carom) works elsewhere.
include(CMakePackageConfigHelpers)

get_property(libraries GLOBAL PROPERTY CAROM_LIBRARIES)
install(TARGETS ${libraries} EXPORT carom-targets FILE_SET HEADERS)
if(TARGET carom)
    install(TARGETS carom)
    install(FILES ${PROJECT_SOURCE_DIR}/apps/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME carom)
endif()
install(EXPORT carom-targets NAMESPACE carom:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/carom)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/carom-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/carom-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/carom)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/carom-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/carom-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/carom-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/carom)

# For build systems other than CMake: the engine, without the files of io.
set(carom_pc_requires fmt)
if(CAROM_EXECUTOR STREQUAL "tbb")
    string(APPEND carom_pc_requires " tbb")
endif()
# Relative, so that an installed copy can be moved.
file(RELATIVE_PATH carom_pc_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(${CMAKE_CURRENT_LIST_DIR}/carom.pc.in ${CMAKE_CURRENT_BINARY_DIR}/carom.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/carom.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
