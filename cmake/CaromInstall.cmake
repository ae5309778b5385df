# Installs the libraries, headers and program, so that find_package(carom) works elsewhere.
include(CMakePackageConfigHelpers)

get_property(libraries GLOBAL PROPERTY CAROM_LIBRARIES)
install(TARGETS ${libraries} EXPORT carom-targets FILE_SET HEADERS)
if(TARGET carom)
    install(TARGETS carom)
endif()
install(EXPORT carom-targets NAMESPACE carom:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/carom)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/carom-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/carom-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/carom)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/carom-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/carom-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/carom-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/carom)
