// The width of a picture's own box, so that one unit of its drawing is one pixel wherever it stands.
import { useEffect, useRef, useState } from "preact/hooks";

export function useWidth<Box extends Element>(first: number) {
  const box = useRef<Box>(null);
  const [width, setWidth] = useState(first);
  useEffect(() => {
    const observer = new ResizeObserver(([entry]) => entry && entry.contentRect.width > 0 && setWidth(Math.floor(entry.contentRect.width)));
    if (box.current) observer.observe(box.current);
    return () => observer.disconnect();
  }, []);
  return { box, width };
}
