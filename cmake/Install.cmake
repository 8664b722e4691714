# Components: `program` with all that its commands use, `module` of the package for Python, `library` where it is shared,
# `laws` for contact laws of one's own, `development` for programs that link the library.
include(CMakePackageConfigHelpers)

install(TARGETS pyroclast EXPORT pyroclastTargets
        LIBRARY COMPONENT library NAMELINK_COMPONENT development
        ARCHIVE COMPONENT development)
install(TARGETS pyroclast_laws EXPORT pyroclastLawsTargets COMPONENT laws)
install(TARGETS pyroclast_app COMPONENT program)
install(DIRECTORY src/pyroclast DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT laws
        FILES_MATCHING PATTERN "*.hpp" PATTERN "app" EXCLUDE PATTERN "python" EXCLUDE)
install(FILES ${PROJECT_BINARY_DIR}/generated/pyroclast/version.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pyroclast
        COMPONENT laws)
install(DIRECTORY cases examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program
        PATTERN "__pycache__" EXCLUDE)
install(FILES CHANGELOG.md CITATION.cff LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)

install(CODE "message(STATUS \"import pyroclast: export PYTHONPATH='\${CMAKE_INSTALL_PREFIX}/${PYROCLAST_PYTHON_DIR}'\")"
        COMPONENT module)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/pyroclast)
install(EXPORT pyroclastTargets NAMESPACE pyroclast:: DESTINATION ${package_folder} COMPONENT development)
install(EXPORT pyroclastLawsTargets NAMESPACE pyroclast:: DESTINATION ${package_folder} COMPONENT laws)
configure_package_config_file(cmake/pyroclastConfig.cmake.in ${PROJECT_BINARY_DIR}/pyroclastConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/pyroclastConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/pyroclastConfig.cmake ${PROJECT_BINARY_DIR}/pyroclastConfigVersion.cmake
              cmake/InstructionSets.cmake cmake/AddLaw.cmake cmake/law.cpp.in cmake/law_packs.cpp.in
        DESTINATION ${package_folder} COMPONENT laws)
install(FILES cmake/Dependencies.cmake DESTINATION ${package_folder} COMPONENT development)
