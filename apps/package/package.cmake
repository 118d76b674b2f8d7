# SPDX-License-Identifier: Apache-2.0
# What is installed, and Debian packages of it. Components: program, doc, dev.

# Manual pages and completions, by the program's own table.
add_executable(petzval_manual apps/package/main.cpp)
target_link_libraries(petzval_manual PRIVATE petzval_apps_commands petzval_apps_package)
set(manual ${CMAKE_BINARY_DIR}/manual)
add_custom_command(OUTPUT ${manual}/man/petzval.1.gz
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${manual}
    COMMAND petzval_manual ${manual}
    COMMAND gzip --recursive --no-name --best ${manual}/man
    DEPENDS petzval_manual COMMENT "Writing manual pages and completions" VERBATIM)
add_custom_target(petzval_manual_pages ALL DEPENDS ${manual}/man/petzval.1.gz)

# What Debian wants to know of a package: the date of its version, and its licence.
file(STRINGS CHANGELOG.md released REGEX "^## ${PROJECT_VERSION}, ")
string(REPLACE "## ${PROJECT_VERSION}, " "" released "${released}")
execute_process(COMMAND date --utc --rfc-email --date "${released}"
    OUTPUT_VARIABLE released OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
set(maintainer "Petzval's developers <petzval@example.org>")
set(about ${CMAKE_BINARY_DIR}/about)
file(CONFIGURE OUTPUT ${about}/changelog CONTENT
"petzval (${PROJECT_VERSION}) unstable; urgency=medium

  * petzval-doc has them: /usr/share/doc/petzval-doc/CHANGELOG.md.

 -- ${maintainer}  ${released}
")
execute_process(COMMAND gzip --no-name --best --force ${about}/changelog COMMAND_ERROR_IS_FATAL ANY)

set(docs ${CMAKE_INSTALL_DATADIR}/doc)
install(TARGETS petzval COMPONENT program)
# Without the scripts that make the scenes.
install(DIRECTORY assets/ DESTINATION ${CMAKE_INSTALL_DATADIR}/petzval COMPONENT program
    PATTERN make EXCLUDE)
install(DIRECTORY ${manual}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(DIRECTORY ${manual}/bash/ COMPONENT program
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
# Where Debian's zsh looks: for packages, and below /usr/local.
install(CODE "set(folder site-functions)
    if(CMAKE_INSTALL_PREFIX MATCHES \"/usr\$\")
        set(folder vendor-completions)
    endif()
    file(INSTALL \"${manual}/zsh/_petzval\"
        DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/zsh/\${folder}\")"
    COMPONENT program)
set(packages petzval:program petzval-doc:doc libpetzval-dev:dev)
if(TARGET petzval_python)
    list(APPEND packages python3-petzval:python)
endif()
foreach(package ${packages})
    string(REPLACE ":" ";" package ${package})
    list(GET package 0 name)
    list(GET package 1 component)
    install(FILES apps/package/copyright ${about}/changelog.gz DESTINATION ${docs}/${name}
        COMPONENT ${component})
endforeach()
install(DIRECTORY docs DESTINATION ${docs}/petzval-doc COMPONENT doc)
install(FILES README.md CHANGELOG.md DESTINATION ${docs}/petzval-doc COMPONENT doc)

# Two archives for other programs: the lens, which needs neither Embree nor OpenImageIO nor oneTBB,
# and the rest. Each has the objects of its rooms, and their headers by the names that they include.
get_property(render_rooms GLOBAL PROPERTY petzval_rooms)
set(lens_rooms core/math core/sampling core/spectrum camera camera/lens camera/iris camera/dispersion
    camera/models camera/bench camera/waves io/base io/file io/glass io/lens)
list(FILTER render_rooms EXCLUDE REGEX "^(apps/(cli|commands|package|chart|python)|io/(codec|plot))")
list(REMOVE_ITEM render_rooms ${lens_rooms})
foreach(archive lens render)
    set(objects)
    foreach(room ${${archive}_rooms})
        string(REPLACE "/" "_" target petzval_${room})
        get_target_property(type ${target} TYPE)
        if(type STREQUAL STATIC_LIBRARY)
            list(APPEND objects $<TARGET_OBJECTS:${target}>)
        endif()
        file(GLOB headers CONFIGURE_DEPENDS ${room}/*.h)
        install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/petzval/${room} COMPONENT dev)
    endforeach()
    add_library(petzval_${archive} STATIC ${objects})
    set_target_properties(petzval_${archive} PROPERTIES LINKER_LANGUAGE CXX)
    install(TARGETS petzval_${archive} DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
endforeach()
install(FILES ${draco_codecs} DESTINATION ${CMAKE_INSTALL_LIBDIR}/petzval COMPONENT dev)

include(CMakePackageConfigHelpers)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/Petzval)
configure_package_config_file(apps/package/PetzvalConfig.cmake.in ${CMAKE_BINARY_DIR}/PetzvalConfig.cmake
    INSTALL_DESTINATION ${package} PATH_VARS CMAKE_INSTALL_LIBDIR CMAKE_INSTALL_INCLUDEDIR
    CMAKE_INSTALL_BINDIR)
# Below 1.0 a new minor version may break what used the one before (semver.org, 2.0.0, item 4).
write_basic_package_version_file(${CMAKE_BINARY_DIR}/PetzvalConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/PetzvalConfig.cmake ${CMAKE_BINARY_DIR}/PetzvalConfigVersion.cmake
    DESTINATION ${package} COMPONENT dev)

# Debian packages, by cpack -G DEB.
set(CPACK_GENERATOR DEB)
list(TRANSFORM packages REPLACE ".*:" "" OUTPUT_VARIABLE CPACK_COMPONENTS_ALL)
set(CPACK_PACKAGE_CONTACT "${maintainer}")
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE
    GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME petzval)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "fonts-dejavu-core")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "gnuplot-nox, petzval-doc")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "spectral path tracer whose camera is a real lens
Petzval renders glTF scenes. Each wavelength's ray is traced through the glass
surfaces of a lens prescription. Pictures are written as EXR, PNG and JPEG.")
set(CPACK_DEBIAN_DOC_PACKAGE_NAME petzval-doc)
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
set(CPACK_COMPONENT_DOC_DESCRIPTION "documentation of the path tracer Petzval
Guides, the design, what was measured, and pictures.")
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libpetzval-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "petzval (= ${PROJECT_VERSION}), libembree-dev, libtbb-dev, \
libimath-dev, libopencolorio-dev, libtinygltf-dev, nlohmann-json3-dev, libfmt-dev, libpugixml-dev, \
libdraco-dev, libmeshoptimizer-dev")
set(CPACK_COMPONENT_DEV_DESCRIPTION "headers and archives of the path tracer Petzval
For programs that trace lenses, or that render scenes through them.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-petzval)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
math(EXPR python_after "0${Python3_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "petzval (= ${PROJECT_VERSION}), python3-numpy, \
python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${python_after})")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "path tracer Petzval from Python
Renders glTF scenes through real lenses to numpy arrays, and traces lenses.")
include(CPack)
