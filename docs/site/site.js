// Opened from disk the browser keeps the index of the search from its page: no box that finds nothing.
if (location.protocol === "file:") document.documentElement.classList.add("no-search");
