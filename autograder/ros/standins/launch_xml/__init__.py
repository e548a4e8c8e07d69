"""In place of `launch_xml`, which reads XML launch files: importing it says where it is to be had."""

from standin_notice import not_covered

raise not_covered("launch_xml", standin="launch", reason="Write the launch file in Python, as the course does")
