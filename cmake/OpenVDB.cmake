# OpenVDB::openvdb. Debian's find module asks for compiled Boost libraries; its headers only need Boost's headers.
if(NOT TARGET OpenVDB::openvdb)
  include(CMakeFindDependencyMacro)
  find_dependency(TBB CONFIG)
  find_path(VOLGI_OPENVDB_INCLUDE openvdb/openvdb.h REQUIRED)
  find_library(VOLGI_OPENVDB_LIBRARY openvdb REQUIRED)
  add_library(OpenVDB::openvdb UNKNOWN IMPORTED GLOBAL)
  set_target_properties(OpenVDB::openvdb PROPERTIES
    IMPORTED_LOCATION ${VOLGI_OPENVDB_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${VOLGI_OPENVDB_INCLUDE}
    INTERFACE_LINK_LIBRARIES TBB::tbb)
endif()
