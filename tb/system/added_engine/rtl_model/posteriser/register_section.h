// SPDX-License-Identifier: MIT
#pragma once

#include "rtl_model/fabric/register_section.h"

namespace deburr::rtl::posteriser {

RegisterSection register_section();

}  // namespace deburr::rtl::posteriser
