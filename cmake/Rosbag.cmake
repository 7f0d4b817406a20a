# Reading ROS 1 bags needs librosbag-storage-dev and libsensor-msgs-dev. Their
# own CMake files ask for all of ROS, so headers and libraries are looked for
# here.
option(HINDSIGHT_ROSBAG "Read ROS 1 bags where librosbag is installed" ON)

function(hindsight_link_rosbag target)
  if(NOT HINDSIGHT_ROSBAG)
    return()
  endif()
  set(found)
  foreach(header rosbag/bag.h sensor_msgs/Imu.h sensor_msgs/NavSatFix.h
                 pluginlib/class_loader.hpp class_loader/class_loader.hpp
                 rcpputils/shared_library.hpp rcutils/shared_library.h
                 ament_index_cpp/get_package_prefix.hpp)
    get_filename_component(package ${header} DIRECTORY)
    string(MAKE_C_IDENTIFIER "ROSBAG_${header}" variable)
    find_path(${variable} ${header} PATH_SUFFIXES ${package})
    mark_as_advanced(${variable})
    list(APPEND found ${${variable}})
    list(APPEND includes ${${variable}})
  endforeach()
  foreach(name rosbag_storage cpp_common roscpp_serialization rostime)
    find_library(ROSBAG_${name} ${name})
    mark_as_advanced(ROSBAG_${name})
    list(APPEND found ${ROSBAG_${name}})
    list(APPEND libraries ${ROSBAG_${name}})
  endforeach()
  if(found MATCHES "NOTFOUND")
    message(STATUS "librosbag is not installed: ROS 1 bags will not be read")
    return()
  endif()
  list(REMOVE_DUPLICATES includes)
  list(REMOVE_ITEM includes /usr/include)
  target_include_directories(${target} SYSTEM PRIVATE ${includes})
  target_link_libraries(${target} PRIVATE ${libraries})
  # The message headers use what C++20 has taken out of std::allocator.
  set_source_files_properties(src/io/rosbag.cc PROPERTIES
    COMPILE_OPTIONS -std=c++17)
  target_compile_definitions(${target} PUBLIC HINDSIGHT_ROSBAG)
endfunction()
