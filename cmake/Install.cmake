# find_package(volgi CONFIG) after `cmake --install`: libraries and public headers; programs install themselves in apps/.
# tests/package uses the result from outside.
include(CMakePackageConfigHelpers)
set(VOLGI_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/volgi)
set(VOLGI_HEADER_DIR ${CMAKE_INSTALL_INCLUDEDIR}/volgi)

get_property(rooms GLOBAL PROPERTY VOLGI_TARGETS)
install(TARGETS volgi_options ${rooms} EXPORT volgiTargets)
install(EXPORT volgiTargets NAMESPACE volgi:: DESTINATION ${VOLGI_PACKAGE_DIR})

# A room's public headers are those in its folder and its leaves.
set(folders core core/gltf core/visibility reference voxel propagation propagation/light_in propagation/lobes propagation/sweep)
if(VOLGI_MPI)
  list(APPEND folders core/mpi)
endif()
if(VOLGI_GL)
  list(APPEND folders core/gl)
  file(GLOB_RECURSE leaves CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} screen/*.h)
  list(TRANSFORM leaves REPLACE "/[^/]*$" "")
  list(REMOVE_DUPLICATES leaves)
  list(APPEND folders ${leaves})
endif()
foreach(folder IN LISTS folders)
  file(GLOB headers CONFIGURE_DEPENDS ${folder}/*.h)
  list(FILTER headers EXCLUDE REGEX "_internal\\.h$")
  if(NOT VOLGI_GL)
    list(FILTER headers EXCLUDE REGEX "_gl\\.h$")
  endif()
  install(FILES ${headers} DESTINATION ${VOLGI_HEADER_DIR}/${folder})
endforeach()
install(DIRECTORY shaders DESTINATION ${VOLGI_HEADER_DIR} FILES_MATCHING PATTERN "*.shared.h")
# For shaders of other programs (examples/minimal).
install(FILES shaders/screen/library/volume_light.glsl DESTINATION ${VOLGI_HEADER_DIR}/shaders/screen/library)

configure_package_config_file(cmake/volgiConfig.cmake.in ${PROJECT_BINARY_DIR}/volgiConfig.cmake
  INSTALL_DESTINATION ${VOLGI_PACKAGE_DIR} NO_SET_AND_CHECK_MACRO)
# Before 1.0 a minor version may change anything.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/volgiConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/OpenVDB.cmake ${PROJECT_BINARY_DIR}/volgiConfig.cmake ${PROJECT_BINARY_DIR}/volgiConfigVersion.cmake
  DESTINATION ${VOLGI_PACKAGE_DIR})
