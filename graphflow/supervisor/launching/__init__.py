"""From a graph file to a running supervisor: classes are imported and asked, launch files run, programs found."""
