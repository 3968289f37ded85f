# cpack: volgi_VERSION_ARCH.deb (programs), volgi-dev_VERSION_ARCH.deb (libraries and headers), and a .tar.gz of the
# programs with their libraries, which runs where it is unpacked. docs/packages.md says what is in them.
set(CPACK_PACKAGE_NAME volgi)
set(CPACK_PACKAGE_VENDOR "volgi")
set(CPACK_PACKAGE_CONTACT "volgi <volgi@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION "Lights glTF scenes by volume, on OpenGL 4.5 or on the CPU, and measures how wrong each technique is \
against a path tracer. With a viewer, and OpenVDB files of the light.")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR "DEB;TGZ")
set(CPACK_THREADS 0)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_LIST_DIR}/PackageKinds.cmake)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_NAME volgi)
# Opened by name at run time, so that shlibdeps does not see them: EGL, OpenGL, and a driver.
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_DEPENDS "libegl1, libgl1, libgl1-mesa-dri")
set(CPACK_DEBIAN_PROGRAMS_PACKAGE_SUGGESTS "ffmpeg")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME volgi-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
# What volgiConfig.cmake looks for.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libglm-dev, libfmt-dev, libtbb-dev, nlohmann-json3-dev, libopenexr-dev, libdraco-dev, \
libmeshoptimizer-dev, libwebp-dev, libstb-dev, libembree-dev, libopenvdb-dev, libboost-dev, libepoxy-dev, libegl-dev")

# The libraries of the programs, but for those that belong to the system: the C and C++ runtime, X11, and what finds the
# driver. After the programs, in the component that the archive alone has.
set(programs "$<TARGET_FILE:volgi>")
if(TARGET volgi-demo)
  list(APPEND programs "$<TARGET_FILE:volgi-demo>")
endif()
install(CODE "
  file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${programs} RESOLVED_DEPENDENCIES_VAR found UNRESOLVED_DEPENDENCIES_VAR missing
    PRE_EXCLUDE_REGEXES [[^(ld-linux|linux-vdso|lib(c|m|dl|rt|pthread|resolv|stdc\\+\\+|gcc_s|GL|EGL|OpenGL|GLX|GLdispatch|X.*|xcb.*|bsd|md)\\.so)]])
  if(missing)
    message(FATAL_ERROR \"libraries that are not found: \${missing}\")
  endif()
  foreach(library IN LISTS found)
    file(INSTALL \${library} DESTINATION \${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/volgi FOLLOW_SYMLINK_CHAIN)
  endforeach()
" COMPONENT bundle EXCLUDE_FROM_ALL)

# What the programs are made of (SPDX 2.3), looked up when they are installed.
find_package(Python3 COMPONENTS Interpreter)
if(Python3_Interpreter_FOUND)
  install(CODE "
    execute_process(COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/sbom.py ${PROJECT_VERSION}
      \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DOCDIR}/volgi.spdx.json ${programs} COMMAND_ERROR_IS_FATAL ANY)
  " COMPONENT programs)
  # Who hands libraries on hands on their licences.
  install(CODE "
    execute_process(COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/sbom.py --licences
      \$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DOCDIR}/licences ${programs} COMMAND_ERROR_IS_FATAL ANY)
  " COMPONENT bundle EXCLUDE_FROM_ALL)
endif()
install(FILES ${PROJECT_SOURCE_DIR}/CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT programs)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT programs)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/volgi-dev RENAME copyright
  COMPONENT development)
if(PROJECT_IS_TOP_LEVEL)  # a project that has this one inside has packages of its own
  include(CPack)
endif()
