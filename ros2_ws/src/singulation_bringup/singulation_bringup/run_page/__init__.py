"""The page of a run: a demo's result folder as one HTML file that needs no network and no other file."""

from singulation_bringup.run_page.page import PAGE, write_page

__all__ = ["PAGE", "write_page"]
