"""What the page shows, and what it may ask: plain numbers, texts and arrays, without a browser."""
