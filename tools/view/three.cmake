# three.js draws the surface on the page of `planetree view`. It is no Debian package, so that it
# comes from npm, once: the archive is kept in a folder that all build folders share. Its hash is
# checked. Without the archive and without a network the command is built all the same, and the page
# of `planetree view` has texts and no picture.
set(PLANETREE_THREE_TARBALL "" CACHE STRING
  "three-0.187.0.tgz of npm, for the page of planetree view; empty: kept in ~/.cache/planetree, and downloaded if it is not there; OFF: do without")
set(planetree_three_name three-0.187.0.tgz)
set(planetree_three_url https://registry.npmjs.org/three/-/${planetree_three_name})
set(planetree_three_sha256 ff540832ded0cfe919764d24a3d88f3e2a05f23303f876423e4f893841e90728)

# Sets `out` to whether a file is the archive.
function(planetree_is_three path out)
  set(${out} OFF PARENT_SCOPE)
  if(EXISTS ${path})
    file(SHA256 ${path} hash)
    if(hash STREQUAL planetree_three_sha256)
      set(${out} ON PARENT_SCOPE)
    endif()
  endif()
endfunction()

# Sets `out` to the path of the archive in the shared folder, where it is downloaded to if it is not
# there. Empty if it cannot be had.
function(planetree_download_three out)
  set(folder $ENV{XDG_CACHE_HOME})
  if(NOT folder)
    set(folder $ENV{HOME}/.cache)
  endif()
  set(kept ${folder}/planetree/${planetree_three_name})
  set(${out} "" PARENT_SCOPE)
  planetree_is_three(${kept} is_kept)
  if(NOT is_kept)
    # Under another name until it is whole, as other configurations may look for it.
    string(RANDOM LENGTH 8 suffix)
    file(DOWNLOAD ${planetree_three_url} ${kept}.${suffix} TIMEOUT 60 INACTIVITY_TIMEOUT 10
      STATUS status)
    planetree_is_three(${kept}.${suffix} is_kept)
    if(is_kept)
      file(RENAME ${kept}.${suffix} ${kept})
    else()
      file(REMOVE ${kept}.${suffix})
    endif()
  endif()
  if(is_kept)
    set(${out} ${kept} PARENT_SCOPE)
  endif()
endfunction()

# Sets `out` to a folder with the files of three.js that the page uses. Empty if they cannot be had.
function(planetree_find_three out)
  set(${out} "" PARENT_SCOPE)
  set(remedy "planetree view will show no picture; for one, configure again with a network, or with -DPLANETREE_THREE_TARBALL=FILE and ${planetree_three_url}")
  if(PLANETREE_THREE_TARBALL STREQUAL "")
    planetree_download_three(archive)
    if(NOT archive)
      message(NOTICE "three.js cannot be downloaded: ${remedy}")
      return()
    endif()
  elseif(PLANETREE_THREE_TARBALL)
    set(archive ${PLANETREE_THREE_TARBALL})
    planetree_is_three(${archive} is_archive)
    if(NOT is_archive)
      message(FATAL_ERROR "${archive} is not ${planetree_three_name}, whose SHA-256 is ${planetree_three_sha256}")
    endif()
  else()
    return()
  endif()
  set(files package/build/three.module.js package/build/three.core.js
    package/examples/jsm/controls/OrbitControls.js package/LICENSE)
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/three)
  file(ARCHIVE_EXTRACT INPUT ${archive} DESTINATION ${folder} PATTERNS ${files})
  # Browsers find modules by their paths.
  set(controls ${folder}/package/examples/jsm/controls/OrbitControls.js)
  file(READ ${controls} text)
  string(REPLACE "from 'three'" "from './three.module.js'" text "${text}")
  file(CONFIGURE OUTPUT ${folder}/OrbitControls.js CONTENT "${text}" @ONLY)
  set(${out} ${folder} PARENT_SCOPE)
endfunction()
