include(CMakePackageConfigHelpers)

install(TARGETS pyroclast EXPORT pyroclastTargets)
install(TARGETS pyroclast_laws EXPORT pyroclastLawsTargets)
install(TARGETS pyroclast_app)
install(DIRECTORY src/pyroclast DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp" PATTERN "app" EXCLUDE
        PATTERN "python" EXCLUDE)
install(FILES ${PROJECT_BINARY_DIR}/generated/pyroclast/version.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pyroclast)
install(DIRECTORY cases DESTINATION ${CMAKE_INSTALL_DATADIR}/pyroclast)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/pyroclast)
install(EXPORT pyroclastTargets NAMESPACE pyroclast:: DESTINATION ${package_folder})
install(EXPORT pyroclastLawsTargets NAMESPACE pyroclast:: DESTINATION ${package_folder})
configure_package_config_file(cmake/pyroclastConfig.cmake.in ${PROJECT_BINARY_DIR}/pyroclastConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pyroclastConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pyroclastConfig.cmake ${PROJECT_BINARY_DIR}/pyroclastConfigVersion.cmake
              cmake/Dependencies.cmake cmake/InstructionSets.cmake cmake/AddLaw.cmake cmake/law.cpp.in
              cmake/law_packs.cpp.in DESTINATION ${package_folder})
