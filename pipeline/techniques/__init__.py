"""One room per technique; this page holds the one list of them."""
